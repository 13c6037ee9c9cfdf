// SPDX-License-Identifier: Apache-2.0
// How often a file is opened, told by the kernel. Tested by
// tests/harness/episode/run/load_run_test.cc
#pragma once

#include <sys/inotify.h>
#include <unistd.h>

#include <cstring>
#include <string>

namespace prehend::episode {

class CountReads {
 public:
  explicit CountReads(const std::string& file) {
    // With what closes it, since the kernel tells equal events in a row only once.
    inotify_add_watch(events_, file.c_str(), IN_OPEN | IN_CLOSE);
  }
  ~CountReads() { close(events_); }
  CountReads(const CountReads&) = delete;
  CountReads& operator=(const CountReads&) = delete;

  /// Since the last question.
  int Count() const {
    int opened = 0;
    char buffer[4096];
    for (ssize_t size; (size = read(events_, buffer, sizeof buffer)) > 0;) {
      for (ssize_t at = 0; at < size;) {
        inotify_event event;
        std::memcpy(&event, buffer + at, sizeof event);
        if (event.mask & IN_OPEN) ++opened;
        at += static_cast<ssize_t>(sizeof event + event.len);
      }
    }
    return opened;
  }

 private:
  const int events_ = inotify_init1(IN_NONBLOCK);
};

}  // namespace prehend::episode
