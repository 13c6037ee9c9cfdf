// SPDX-License-Identifier: Apache-2.0
#include "harness/base/process/run_tool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

extern char** environ;

namespace prehend {
namespace {

using Clock = std::chrono::steady_clock;

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { Close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  void Reset(int number) {
    Close();
    number_ = number;
  }
  void Close() {
    if (number_ >= 0) close(number_);
    number_ = -1;
  }
  int number() const { return number_; }
  bool IsOpen() const { return number_ >= 0; }

 private:
  int number_ = -1;
};

/// Both ends close when another program starts. Sockets, because writing to one whose reader is
/// gone need not raise a signal.
bool Connect(Descriptor& ours, Descriptor& its) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return false;
  ours.Reset(ends[0]);
  its.Reset(ends[1]);
  return fcntl(ends[0], F_SETFL, O_NONBLOCK) == 0;
}

/// What the program still has to read is sent as far as it takes it.
void Send(Descriptor& input, const std::string& text, std::size_t& sent) {
  const ssize_t count = send(input.number(), text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
  if (count > 0) sent += static_cast<std::size_t>(count);
  const bool is_gone = count < 0 && errno != EAGAIN && errno != EINTR;
  if (sent == text.size() || is_gone) input.Close();
}

void Receive(Descriptor& output, std::string& text) {
  std::array<char, 65536> bytes;
  const ssize_t count = recv(output.number(), bytes.data(), bytes.size(), 0);
  if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) output.Close();
}

}  // namespace

ToolResult RunTool(const std::vector<std::string>& words, const std::string& input,
                   const ToolLimits& limits) {
  ToolResult result;
  Descriptor in, out, err, its_in, its_out, its_err;
  if (!Connect(in, its_in) || !Connect(out, its_out) || !Connect(err, its_err)) {
    result.problem = std::string("no connection to it: ") + std::strerror(errno);
    return result;
  }
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, its_in.number(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, its_out.number(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, its_err.number(), STDERR_FILENO);
  pid_t process = 0;
  const int failed =
      posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    result.problem = failed == ENOENT
                         ? fmt::format("'{}' is not installed", words[0])
                         : fmt::format("'{}' cannot be started: {}", words[0], strerror(failed));
    return result;
  }
  if (limits.memory_bytes > 0) {
    const rlimit limit{limits.memory_bytes, limits.memory_bytes};
    prlimit(process, RLIMIT_AS, &limit, nullptr);
  }
  its_in.Close();
  its_out.Close();
  its_err.Close();

  double time_s = limits.time_s;
  auto deadline = Clock::now() + std::chrono::duration<double>(time_s);
  bool answers = limits.answering_s <= 0;
  std::size_t sent = 0;
  if (input.empty()) in.Close();
  while (out.IsOpen() || err.IsOpen()) {
    const double left_s = std::chrono::duration<double>(deadline - Clock::now()).count();
    if (left_s <= 0) result.problem = fmt::format("took more than {:g} s", time_s);
    if (result.out.size() + result.err.size() > limits.output_bytes)
      result.problem = fmt::format("printed more than {} bytes", limits.output_bytes);
    if (!result.problem.empty()) break;
    // A closed descriptor is -1, which poll() passes over.
    std::array<pollfd, 3> watched{
        pollfd{in.number(), POLLOUT, 0}, {out.number(), POLLIN, 0}, {err.number(), POLLIN, 0}};
    if (poll(watched.data(), watched.size(), static_cast<int>(left_s * 1000) + 1) < 0) continue;
    if (watched[0].revents != 0) Send(in, input, sent);
    if (watched[1].revents != 0) Receive(out, result.out);
    if (!answers && result.out.find('\n') != std::string::npos) {
      answers = true;
      time_s = limits.answering_s;
      deadline = Clock::now() + std::chrono::duration<double>(time_s);
    }
    if (watched[2].revents != 0) Receive(err, result.err);
  }
  if (!result.problem.empty()) kill(process, SIGKILL);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status))
    result.exit_code = WEXITSTATUS(status);
  else if (result.problem.empty())
    result.problem = fmt::format("was ended by signal {}", WTERMSIG(status));
  return result;
}

}  // namespace prehend
