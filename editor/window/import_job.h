// An import beside the frames: a thread of its own makes the files, the window's thread takes them into the project.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "editor/recipe/progress.h"

namespace loam::window {

class ImportJob {
  public:
    struct Steps {
        std::string title;                           // "Adding layer moss"
        std::function<Status(const Progress&)> make; // on the job's thread; must not look at the document
        std::function<Status()> adopt;               // on the caller's of `finish`, after `make`
    };
    explicit ImportJob(Steps steps);
    ~ImportJob(); // cancels and waits

    struct Stand {
        double share = 0;
        std::string what; // "measuring formats"
    };
    [[nodiscard]] Stand stand() const;
    [[nodiscard]] const std::string& title() const { return steps_.title; }
    void cancel() { cancelled_ = true; }
    [[nodiscard]] bool done() const { return done_; }
    Status finish(); // once it is done: adopts, or the error of `make`; kCancelled if `cancel` came in time

  private:
    Steps steps_;
    mutable std::mutex mutex_;
    Stand stand_;
    Status made_;
    std::atomic<bool> cancelled_ = false, done_ = false;
    std::thread thread_;
};

} // namespace loam::window
