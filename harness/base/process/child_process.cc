// SPDX-License-Identifier: Apache-2.0
#include "harness/base/process/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace prehend {
namespace {

void Close(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

/// Kills what is left of the children, whoever made them: an orphan becomes a child of this process
/// (PR_SET_CHILD_SUBREAPER).
void EndChildren() {
  const std::string list = fmt::format("/proc/self/task/{}/children", getpid());
  for (int round = 0; round < 1000; ++round) {
    std::FILE* const file = std::fopen(list.c_str(), "r");
    if (!file) return;
    int child = 0, count = 0;
    for (; std::fscanf(file, "%d", &child) == 1; ++count) kill(child, SIGKILL);
    std::fclose(file);
    if (count == 0) return;
    while (waitpid(-1, nullptr, WNOHANG) > 0) {
    }
    usleep(1000);
  }
}

/// In the process above the program: ends as it ends, and nothing is left.
[[noreturn]] void Watch(pid_t program, pid_t parent, const sigset_t& told) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  bool is_over = getppid() != parent;
  int status = 0, code = 128 + SIGKILL;
  while (!is_over) {
    int signal = 0;
    sigwait(&told, &signal);
    is_over = signal == SIGTERM;
    for (pid_t ended = 1; ended > 0;) {
      ended = waitpid(-1, &status, WNOHANG);
      if (ended != program) continue;
      is_over = true;
      code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
  }
  EndChildren();
  _exit(code);
}

/// In the child: becomes the program, within its limits from the first instruction on.
[[noreturn]] void Become(const std::vector<char*>& arguments, const std::vector<char*>& more,
                         const ChildProcess::How& how, int problem) {
  const auto limit = [](auto resource, rlim_t most) {
    const rlimit both{most, most};
    if (most > 0) setrlimit(resource, &both);
  };
  limit(RLIMIT_AS, how.memory_bytes);
  limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(how.cpu_s)));
  for (char* one : more) putenv(one);
  execvp(arguments[0], arguments.data());
  const int why = errno;
  (void)!write(problem, &why, sizeof why);
  _exit(127);
}

std::vector<char*> Pointers(const std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  return pointers;
}

}  // namespace

ChildProcess::~ChildProcess() {
  if (process_ > 0) Kill();
  for (int* one : {&in_, &out_, &err_}) Close(*one);
}

std::string ChildProcess::Start(const std::vector<std::string>& words, const How& how) {
  // Sockets, because writing to one whose reader is gone need not raise a signal.
  int ends[4][2] = {{-1, -1}, {-1, -1}, {-1, -1}, {-1, -1}};
  for (auto& pair : ends)
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0)
      return std::string("no connection to it: ") + std::strerror(errno);
  std::vector<char*> arguments = Pointers(words), more = Pointers(how.environment);
  arguments.push_back(nullptr);
  is_watched_ = how.is_watched;
  sigset_t told, before;
  sigemptyset(&told);
  sigaddset(&told, SIGCHLD);
  sigaddset(&told, SIGTERM);
  sigprocmask(SIG_BLOCK, &told, &before);  // until the watching process waits for them
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) {
    if (is_watched_) {
      setpgid(0, 0);
      prctl(PR_SET_CHILD_SUBREAPER, 1);
    }
    const pid_t above = is_watched_ ? fork() : 0;
    if (above == 0) {
      for (int one = 0; one < 3; ++one) dup2(ends[one][1], one);
      sigset_t none;
      sigemptyset(&none);
      sigprocmask(SIG_SETMASK, &none, nullptr);
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (!is_watched_ && getppid() != parent) _exit(127);
      Become(arguments, more, how, ends[3][1]);
    }
    for (auto& pair : ends)
      for (int& one : pair) Close(one);
    Watch(above, parent, told);
  }
  sigprocmask(SIG_SETMASK, &before, nullptr);
  for (auto& pair : ends) Close(pair[1]);
  int why = process_ < 0 ? errno : 0;
  if (process_ > 0) (void)!read(ends[3][0], &why, sizeof why);  // it ends when the program starts
  Close(ends[3][0]);
  if (why != 0) {
    for (int one = 0; one < 3; ++one) Close(ends[one][0]);
    if (process_ > 0) Kill();
    return why == ENOENT ? fmt::format("'{}' is not installed", words[0])
                         : fmt::format("'{}' cannot be started: {}", words[0], std::strerror(why));
  }
  in_ = ends[0][0];
  out_ = ends[1][0];
  err_ = ends[2][0];
  fcntl(in_, F_SETFL, O_NONBLOCK);
  return "";
}

void ChildProcess::Exchange(double most_s, int also) {
  const auto end_input = [&] {
    if (closes_input_ && unsent() == 0 && in_ >= 0) shutdown(in_, SHUT_WR);
  };
  end_input();
  // A closed descriptor is -1, which poll() passes over.
  std::array<pollfd, 4> watched{pollfd{unsent() > 0 ? in_ : -1, POLLOUT, 0},
                                {out_, POLLIN, 0},
                                {err_, POLLIN, 0},
                                {also, POLLIN, 0}};
  if (poll(watched.data(), watched.size(), most_s <= 0 ? 0 : static_cast<int>(most_s * 1000) + 1) <
      0)
    return;
  if (watched[0].revents != 0) {
    const ssize_t count = send(in_, input_.data() + sent_, unsent(), MSG_NOSIGNAL);
    if (count > 0) sent_ += static_cast<std::size_t>(count);
    if (count < 0 && errno != EAGAIN && errno != EINTR) {
      Close(in_);
      is_unread_ = true;
    }
    if (unsent() == 0 || is_unread_) {
      input_.clear();
      sent_ = 0;
    }
    end_input();
  }
  const auto receive = [](int& from, std::string& text) {
    std::array<char, 65536> bytes;
    const ssize_t count = recv(from, bytes.data(), bytes.size(), 0);
    if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) Close(from);
  };
  if (watched[1].revents != 0) receive(out_, out);
  if (watched[2].revents != 0) receive(err_, err);
}

bool ChildProcess::HasReadAll() const {
  int problem = 0;  // ECONNRESET: it was closed with something in it
  socklen_t size = sizeof problem;
  const bool is_lost =
      in_ >= 0 && getsockopt(in_, SOL_SOCKET, SO_ERROR, &problem, &size) == 0 && problem != 0;
  return !is_unread_ && !is_lost && unsent() == 0;
}

bool ChildProcess::HasEnded(double most_s) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(most_s);
  int status = 0;
  rusage used{};
  for (pid_t ended = 0; process_ > 0 && ended == 0;) {
    ended = wait4(process_, &status, most_s < 0 ? 0 : WNOHANG, &used);
    if (ended < 0 && errno == EINTR) ended = 0;
    if (ended == 0 && std::chrono::steady_clock::now() > until && most_s >= 0) return false;
    if (ended == 0) Exchange(0.002);
    if (ended != process_) continue;
    process_ = 0;
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    end_.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
    end_.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    end_.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (is_watched_ && end_.exit_code > 128) end_ = {0, end_.exit_code - 128, end_.cpu_s};
  }
  return true;
}

void ChildProcess::Kill() {
  if (process_ <= 0) return;
  kill(process_, is_watched_ ? SIGTERM : SIGKILL);
  HasEnded(-1);
}

using Clock = std::chrono::steady_clock;

ToolResult RunTool(const std::vector<std::string>& words, const std::string& input,
                   const ToolLimits& limits) {
  ToolResult result;
  ChildProcess tool;
  // If this process is stopped, nobody looks at the clock.
  const double cpu_s = limits.answering_s > 0 ? limits.time_s + limits.answering_s : 0;
  result.problem = tool.Start(words, {.memory_bytes = limits.memory_bytes, .cpu_s = cpu_s});
  if (!result.problem.empty()) return result;
  double time_s = limits.time_s;
  auto deadline = Clock::now() + std::chrono::duration<double>(time_s);
  bool answers = limits.answering_s <= 0;
  tool.Send(input);
  tool.CloseInput();
  while (!tool.has_said_all()) {
    const double left_s = std::chrono::duration<double>(deadline - Clock::now()).count();
    if (left_s <= 0) result.problem = fmt::format("took more than {:g} s", time_s);
    if (tool.out.size() + tool.err.size() > limits.output_bytes)
      result.problem = fmt::format("printed more than {} bytes", limits.output_bytes);
    if (!result.problem.empty()) break;
    tool.Exchange(left_s);
    if (!answers && tool.out.find('\n') != std::string::npos) {
      answers = true;
      time_s = limits.answering_s;
      deadline = Clock::now() + std::chrono::duration<double>(time_s);
    }
  }
  if (result.problem.empty())
    tool.HasEnded(-1);
  else
    tool.Kill();
  result.exit_code = tool.end().exit_code;
  if (tool.end().signal != 0 && result.problem.empty())
    result.problem = fmt::format("was ended by signal {}", tool.end().signal);
  result.out = std::move(tool.out);
  result.err = std::move(tool.err);
  return result;
}

Interrupt::Interrupt() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // A blocked signal reaches the file even if it is ignored.
    struct sigaction action {};
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
      sigaddset(&signals, signal);
  }
  sigprocmask(SIG_BLOCK, &signals, &before_);
  fd_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
  if (fd_ < 0) sigprocmask(SIG_SETMASK, &before_, nullptr);
}

Interrupt::~Interrupt() {
  if (fd_ < 0) return;
  close(fd_);
  sigprocmask(SIG_SETMASK, &before_, nullptr);
}

bool Interrupt::Came() {
  signalfd_siginfo info{};
  if (signal_ == 0 && fd_ >= 0 && read(fd_, &info, sizeof info) == sizeof info) {
    signal_ = static_cast<int>(info.ssi_signo);
    sigprocmask(SIG_SETMASK, &before_, nullptr);
  }
  return signal_ != 0;
}

std::string Interrupt::Name() const {
  return signal_ == 0 ? "" : std::string("SIG") + sigabbrev_np(signal_);
}

void Interrupt::ReleaseInWorker() const {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  if (fd_ >= 0 && sigismember(&before_, SIGTERM) == 0) sigprocmask(SIG_UNBLOCK, &signals, nullptr);
}

void Interrupt::EndProcess() const {
  if (signal_ != 0) raise(signal_);
}

}  // namespace prehend
