// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and its like, put off until what is finished so far has been written. Tested by
// tests/program/interrupt_test.cc
#pragma once

#include <string>

namespace prehend {

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
