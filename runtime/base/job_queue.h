// A small pool of workers. Jobs are closures over values; results come back by value through the caller's own
// queue. Destruction drops the jobs not yet begun and waits for those running.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace loam {

class JobQueue {
  public:
    // 0 workers: jobs run at once in `push`, which makes tests deterministic.
    explicit JobQueue(int worker_count);
    ~JobQueue();
    JobQueue(const JobQueue&) = delete;
    JobQueue& operator=(const JobQueue&) = delete;

    void push(std::function<void()> job);
    void wait_idle();
    [[nodiscard]] int worker_count() const { return static_cast<int>(workers_.size()); }

  private:
    void work();

    std::mutex mutex_;
    std::condition_variable wake_, idle_;
    std::deque<std::function<void()>> jobs_;
    std::vector<std::thread> workers_;
    int running_ = 0;
    bool stop_ = false;
};

// Splits [0, count) into ranges over the hardware's threads and waits. `body(begin, end)` must be independent of
// the split, so that the result does not depend on the number of cores.
void parallel_ranges(int count, int smallest_range, const std::function<void(int begin, int end)>& body);

} // namespace loam
