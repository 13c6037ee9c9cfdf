// SPDX-License-Identifier: Apache-2.0
// Another program that runs beside this one: text goes both ways, and neither waits for the other
// for ever. Another program as a function: text in, text out, within a time. No shell is involved.
// Tested by tests/harness/base/process/child_process_test.cc and
// tests/harness/base/process/run_tool_test.cc
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace prehend {

class ChildProcess {
 public:
  ChildProcess() = default;
  /// Kills it, if it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  struct How {
    std::size_t memory_bytes = 0;               ///< of its address space; 0: any
    double cpu_s = 0;                           ///< of processor time; 0: any
    std::vector<std::string> environment = {};  ///< "NAME=value", beside that of this process
    /// With a process above it, which ends all that it has started when it ends, when it is killed,
    /// and when this process does. Without one, the program itself ends with this process.
    bool is_watched = false;
  };
  /// `words`: the program, which is searched in PATH, and its arguments. "", or why not.
  std::string Start(const std::vector<std::string>& words, const How& how);

  /// To be sent as far as it takes it, by Exchange().
  void Send(std::string_view text) { input_ += text; }
  /// Once all is sent.
  void CloseInput() { closes_input_ = true; }
  std::size_t unsent() const { return input_.size() - sent_; }
  /// Waits at most so long until something can be sent or has come, and moves it. `also`: a
  /// descriptor that ends the wait, too.
  void Exchange(double most_s, int also = -1);
  /// Neither output is open any more.
  bool has_said_all() const { return out_ < 0 && err_ < 0; }
  /// Of one that has ended, whether it read all that was sent.
  bool HasReadAll() const;
  std::string out, err;  ///< what has come; who reads may take it out

  struct End {
    int exit_code = 0, signal = 0;  ///< one of them; signal 0: it ended by itself
    double cpu_s = 0;
  };
  /// Waits at most so long for its end; false if it still runs.
  bool HasEnded(double most_s);
  void Kill();
  /// After HasEnded() or Kill().
  const End& end() const { return end_; }

 private:
  pid_t process_ = 0;
  bool is_watched_ = false;
  int in_ = -1, out_ = -1, err_ = -1;
  std::string input_;
  std::size_t sent_ = 0;
  bool closes_input_ = false, is_unread_ = false;
  End end_;
};

struct ToolLimits {
  double time_s = 60;
  double answering_s = 0;  ///< from its first line on; 0: it has time_s for all
  std::size_t output_bytes = std::size_t{1} << 28;  ///< of standard output and error together
  std::size_t memory_bytes = 0;                     ///< of its address space; 0: any
};

struct ToolResult {
  /// Empty if it ended by itself; else why not: "'rsvg-convert' is not installed", "took more than
  /// 60 s", "was ended by signal 9".
  std::string problem;
  int exit_code = 0;  ///< if it ended by itself
  std::string out, err;

  bool Succeeded() const { return problem.empty() && exit_code == 0; }
};

/// `words`: the program, which is searched in PATH, and its arguments. `input` is its standard
/// input. A program that exceeds a limit is killed.
ToolResult RunTool(const std::vector<std::string>& words, const std::string& input,
                   const ToolLimits& limits = {});

// Ctrl-C and its like, put off until what is finished so far has been written. Tested by
// tests/program/interrupt_test.cc

/// While it lives, the first SIGINT, SIGTERM or SIGHUP does not end this process, but makes fd()
/// readable. A second one ends it at once. Signals that were ignored before stay ignored (nohup).
/// One at a time, in a process without other threads.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// For poll(). -1: the system offers none; then signals end the process.
  int fd() const { return fd_; }

  /// Whether a signal came. Does not wait.
  bool Came();

  /// "SIGINT"; "" before Came().
  std::string Name() const;

  /// In a forked worker: SIGTERM ends it. SIGINT and SIGHUP, which a terminal sends to all, are its
  /// parent's matter.
  void ReleaseInWorker() const;

  /// Ends this process by the signal that came, as a shell expects it. Nothing if none came.
  void EndProcess() const;

 private:
  sigset_t before_;  ///< the signals that were blocked
  int fd_ = -1;
  int signal_ = 0;
};

}  // namespace prehend
