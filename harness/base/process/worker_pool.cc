// SPDX-License-Identifier: Apache-2.0
// One fork and one pipe per job. The parent polls the pipes and kills a child that is late. A job
// has ended when its pipe has.
#include "harness/base/process/worker_pool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>

#include "harness/base/base/input_files.h"

namespace prehend {
namespace {

using Clock = std::chrono::steady_clock;

// Exit statuses of a child whose job did not return.
constexpr int kExceptionExit = 70;
constexpr int kOutOfMemoryExit = 71;
constexpr int kTooLittleMemoryExit = 72;
constexpr int kOutputExit = 73;

/// Of the standard error of a failed worker, at most this much is kept.
constexpr off_t kMaxStderrTail_bytes = 4000;

/// While the parent waits, it has something to say at least so often.
constexpr double kMeanwhile_s = 0.2;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void WriteAll(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Private memory of this process, which RLIMIT_DATA limits: "VmData:   1234 kB"; 0 if the system
/// does not say.
std::uint64_t PrivateMemory_bytes() {
  std::ifstream status("/proc/self/status");
  std::string word;
  std::uint64_t kib = 0;
  while (status >> word) {
    if (word == "VmData:" && status >> kib) return kib << 10;
  }
  return 0;
}

bool IsLackOfMemory(const std::system_error& problem) {
  // A thread for which there is no stack: "try again".
  return problem.code() == std::errc::not_enough_memory ||
         problem.code() == std::errc::resource_unavailable_try_again;
}

/// "crashed (segmentation fault, signal 11)". The system also sends SIGKILL, when the machine has
/// no memory left.
std::string SignalText(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "crashed (segmentation fault, signal 11)";
    case SIGABRT:
      return "aborted (signal 6)";
    case SIGFPE:
      return "crashed (arithmetic error, signal 8)";
    case SIGBUS:
      return "crashed (bus error, signal 7)";
    case SIGILL:
      return "crashed (illegal instruction, signal 4)";
    case SIGKILL:
      return "was killed (signal 9: by a user, or by the system because memory ran out)";
    case SIGTERM:
      return "was terminated (signal 15)";
    case SIGXCPU:
      return "exceeded its processor time (signal 24)";
    default:
      return fmt::format("ended by signal {} ({})", signal, strsignal(signal));
  }
}

/// In the child, first of all.
void EnterLimits(const WorkerLimits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody would read the result of an orphan
  // Also where an exception could not pass: in a destructor, or through a library in C.
  std::set_new_handler([] { _exit(kOutOfMemoryExit); });
  if (limits.memory_limit_bytes > 0) {
    if (PrivateMemory_bytes() > limits.memory_limit_bytes) _exit(kTooLittleMemoryExit);
    const rlimit limit{limits.memory_limit_bytes, limits.memory_limit_bytes};
    setrlimit(RLIMIT_DATA, &limit);
  }
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
}

/// What the child does. It leaves by _exit, because the buffers and destructors are the parent's.
template <typename Job>
[[noreturn]] void Work(const Job& job, const WorkerLimits& limits, int pipe) {
  EnterLimits(limits);
  int status = 0;
  try {
    status = job();
  } catch (const std::bad_alloc&) {
    _exit(kOutOfMemoryExit);
  } catch (const std::system_error& problem) {
    if (IsLackOfMemory(problem)) _exit(kOutOfMemoryExit);
    WriteAll(pipe, problem.what());
    _exit(kExceptionExit);
  } catch (const std::exception& problem) {
    WriteAll(pipe, problem.what());
    _exit(kExceptionExit);
  }
  _exit(status);
}

std::string ReasonOf(int status, const WorkerLimits& limits, bool late, const std::string& said,
                     std::int64_t peak_memory_kib) {
  if (late) return fmt::format("no end after {:g} s", limits.time_limit_s);
  const std::uint64_t limit_mb = limits.memory_limit_bytes / kMegabyte;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  if (code == kOutOfMemoryExit) {
    return limit_mb == 0 ? "no memory is left"
                         : fmt::format("it needs more memory than {} MB", limit_mb);
  }
  if (code == kTooLittleMemoryExit) {
    return fmt::format("{} MB of memory are too little for it to start, which takes {:.0f} MB",
                       limit_mb, std::ceil(static_cast<double>(PrivateMemory_bytes()) / kMegabyte));
  }
  if (code == kExceptionExit) return "exception: " + said;
  if (code == kOutputExit) return "the output could not be written";
  // A library in C that gets no memory aborts, exits or uses a null pointer: the peak shows it.
  const std::string end =
      WIFSIGNALED(status) ? SignalText(WTERMSIG(status)) : fmt::format("exit status {}", code);
  if (limit_mb == 0) return end;
  return fmt::format("{} at {} MB of memory, limit {} MB", end,
                     peak_memory_kib * 1024 / std::int64_t{kMegabyte}, limit_mb);
}

struct Worker {
  std::size_t job = 0;
  pid_t process = 0;
  int pipe = -1;
  int standard_error = -1;  ///< a file without a name
  Clock::time_point start;
  bool killed = false;
  std::string output;
};

class Pool {
 public:
  Pool(const std::vector<WorkerJob>& jobs, const WorkerLimits& limits, Interrupt* interrupt,
       const std::function<void()>& meanwhile)
      : jobs_(jobs),
        limits_(limits),
        interrupt_(interrupt),
        meanwhile_(meanwhile),
        results_(jobs.size()) {}

  std::vector<WorkerResult> Run(const std::function<void(std::size_t, const WorkerResult&)>& done) {
    while (next_ < jobs_.size() || !workers_.empty()) {
      while (next_ < jobs_.size() &&
             workers_.size() < static_cast<std::size_t>(std::max(1, limits_.jobs))) {
        Start(next_++, done);
      }
      if (workers_.empty()) continue;  // none of them could be started
      WaitAndRead(done);
      if (meanwhile_) meanwhile_();
      if (interrupt_ != nullptr && interrupt_->Came()) {
        KillAll();
        break;
      }
    }
    return std::move(results_);
  }

 private:
  using Done = std::function<void(std::size_t, const WorkerResult&)>;

  void Start(std::size_t job, const Done& done) {
    int ends[2];
    if (pipe(ends) != 0)
      return Report(job, {.reason = "no pipe for the worker: " + std::string(std::strerror(errno))},
                    done);
    const int standard_error = memfd_create("standard error of a worker", MFD_CLOEXEC);
    const pid_t process = fork();
    if (process == 0) {
      close(ends[0]);
      dup2(standard_error, STDERR_FILENO);
      if (interrupt_ != nullptr) interrupt_->ReleaseInWorker();
      const auto send = [&] {
        (void)TakeNewInputs();
        const std::string output = jobs_[job]();
        WriteAll(ends[1], TakeNewInputs() + output);
        return 0;
      };
      Work(send, limits_, ends[1]);
    }
    close(ends[1]);
    if (process < 0) {
      close(ends[0]);
      close(standard_error);
      return Report(
          job, {.reason = "no process for the worker: " + std::string(std::strerror(errno))}, done);
    }
    workers_.push_back({.job = job,
                        .process = process,
                        .pipe = ends[0],
                        .standard_error = standard_error,
                        .start = Clock::now(),
                        .killed = false});
  }

  void KillAll() {
    for (const Worker& worker : workers_) {
      kill(worker.process, SIGKILL);
      close(worker.pipe);
      close(worker.standard_error);
      while (waitpid(worker.process, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
    workers_.clear();
  }

  void WaitAndRead(const Done& done) {
    std::vector<pollfd> pipes;
    double nearest_deadline_s =
        meanwhile_ ? std::min(kMeanwhile_s, limits_.time_limit_s) : limits_.time_limit_s;
    for (const Worker& worker : workers_) {
      pipes.push_back({.fd = worker.pipe, .events = POLLIN, .revents = 0});
      if (!worker.killed)
        nearest_deadline_s =
            std::min(nearest_deadline_s, limits_.time_limit_s - SecondsSince(worker.start));
    }
    const int interrupt = interrupt_ == nullptr ? -1 : interrupt_->fd();  // poll() ignores -1
    pipes.push_back({.fd = interrupt, .events = POLLIN, .revents = 0});
    poll(pipes.data(), pipes.size(), std::max(1, static_cast<int>(1000 * nearest_deadline_s) + 1));
    if (pipes.back().revents != 0) return;  // workers may have had the signal, too
    for (std::size_t i = workers_.size(); i-- > 0;) {
      Worker& worker = workers_[i];
      if (!worker.killed && SecondsSince(worker.start) > limits_.time_limit_s) {
        kill(worker.process, SIGKILL);
        worker.killed = true;
      }
      if (pipes[i].revents != 0 && !ReadSome(worker)) {
        Reap(worker, done);
        workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
  }

  /// False at the end of the pipe.
  static bool ReadSome(Worker& worker) {
    char buffer[65536];
    const ssize_t count = read(worker.pipe, buffer, sizeof buffer);
    if (count > 0) worker.output.append(buffer, static_cast<std::size_t>(count));
    return count > 0 || (count < 0 && errno == EINTR);
  }

  void Reap(Worker& worker, const Done& done) {
    close(worker.pipe);
    int status = 0;
    rusage usage{};
    while (wait4(worker.process, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    WorkerResult result{.finished = WIFEXITED(status) && WEXITSTATUS(status) == 0};
    result.seconds = SecondsSince(worker.start);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime})
      result.cpu_s += static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
    result.peak_memory_kib = usage.ru_maxrss;
    std::string stderr_tail = StderrTail(worker);
    if (result.finished) {
      result.output = RememberInputs(worker.output);
      std::cerr << stderr_tail;
    } else {
      result.reason =
          ReasonOf(status, limits_, worker.killed, worker.output, result.peak_memory_kib);
      // Once memory has run out, messages of libraries are only consequences.
      const bool out_of_memory = WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemoryExit;
      if (!out_of_memory) result.stderr_tail = std::move(stderr_tail);
    }
    Report(worker.job, std::move(result), done);
  }

  /// The end, because a crash is explained there.
  static std::string StderrTail(const Worker& worker) {
    const int file = worker.standard_error;
    const off_t size = std::max<off_t>(0, lseek(file, 0, SEEK_END));
    std::string tail(static_cast<std::size_t>(std::min(size, kMaxStderrTail_bytes)), '\0');
    const ssize_t count =
        pread(file, tail.data(), tail.size(), size - static_cast<off_t>(tail.size()));
    tail.resize(static_cast<std::size_t>(std::max<ssize_t>(0, count)));
    close(file);
    return tail;
  }

  void Report(std::size_t job, WorkerResult result, const Done& done) {
    results_[job] = std::move(result);
    if (done) done(job, results_[job]);
  }

  const std::vector<WorkerJob>& jobs_;
  const WorkerLimits limits_;
  Interrupt* const interrupt_;
  const std::function<void()>& meanwhile_;
  std::vector<WorkerResult> results_;
  std::vector<Worker> workers_;
  std::size_t next_ = 0;
};

}  // namespace

LimitedEnd RunWithinLimits(const std::function<int()>& job, const WorkerLimits& limits,
                           Interrupt* interrupt) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return {.status = 0, .reason = "no pipe: " + std::string(std::strerror(errno))};
  std::cout.flush();
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t process = fork();
  if (process == 0) {
    close(ends[0]);
    if (interrupt) interrupt->ReleaseInWorker();
    const auto work = [&] {
      const int status = job();
      return std::cout.flush() ? status : kOutputExit;
    };
    Work(work, limits, ends[1]);
  }
  const std::string no_process = process < 0 ? std::strerror(errno) : "";
  close(ends[1]);
  const Clock::time_point start = Clock::now();
  bool late = false;
  std::string said;
  for (bool open = process > 0; open;) {
    const double left_s = limits.time_limit_s - SecondsSince(start);
    const int stop = interrupt && !late ? interrupt->fd() : -1;
    pollfd both[2] = {{.fd = ends[0], .events = POLLIN, .revents = 0},
                      {.fd = stop, .events = POLLIN, .revents = 0}};
    const pollfd& end = both[0];
    const bool has_limit = limits.time_limit_s > 0 && !late;
    poll(both, 2, has_limit ? std::max(0, static_cast<int>(1000 * left_s) + 1) : -1);
    if (end.revents != 0) {
      char buffer[4096];
      const ssize_t count = read(ends[0], buffer, sizeof buffer);
      if (count > 0) said.append(buffer, static_cast<std::size_t>(count));
      open = count > 0 || (count < 0 && errno == EINTR);
    } else if (both[1].revents != 0 || (has_limit && SecondsSince(start) > limits.time_limit_s)) {
      kill(process, SIGKILL);
      late = true;
    }
  }
  close(ends[0]);
  if (process < 0) return {.status = 0, .reason = "no process: " + no_process};
  int status = 0;
  rusage usage{};
  while (wait4(process, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  // Workers of one that was killed die with it, and are this process's then.
  while (WIFSIGNALED(status) && (waitpid(-1, nullptr, 0) > 0 || errno == EINTR)) {
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPIPE) {
    // Nobody reads any more, as in "prehend list | head": ended quietly, as other programs.
    signal(SIGPIPE, SIG_DFL);
    raise(SIGPIPE);
  }
  const bool returned = WIFEXITED(status) && WEXITSTATUS(status) < kExceptionExit;
  if (returned) return {.status = WEXITSTATUS(status), .reason = ""};
  if (WIFEXITED(status) && WEXITSTATUS(status) == kExceptionExit) throw std::runtime_error(said);
  return {.status = 0, .reason = ReasonOf(status, limits, late, said, usage.ru_maxrss)};
}

std::vector<WorkerResult> RunInWorkers(
    const std::vector<WorkerJob>& jobs, const WorkerLimits& limits,
    const std::function<void(std::size_t, const WorkerResult&)>& done, Interrupt* interrupt,
    const std::function<void()>& meanwhile) {
  return Pool(jobs, limits, interrupt, meanwhile).Run(done);
}

ProgressCounters::ProgressCounters(std::size_t count) : count_(std::max<std::size_t>(1, count)) {
  static_assert(Tick::is_always_lock_free);  // otherwise it would not work between processes
  void* memory = mmap(nullptr, count_ * sizeof(Tick), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  ticks_ = static_cast<Tick*>(memory);
  for (std::size_t i = 0; i < count_; ++i) new (&ticks_[i]) Tick(kNone);
}

ProgressCounters::~ProgressCounters() { munmap(ticks_, count_ * sizeof(Tick)); }

}  // namespace prehend
