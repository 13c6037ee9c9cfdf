// SPDX-License-Identifier: Apache-2.0
#include "harness/base/process/interrupt.h"

#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>

namespace prehend {

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
