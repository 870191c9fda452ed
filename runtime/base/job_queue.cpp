#include "runtime/base/job_queue.h"

#include <algorithm>

namespace loam {

JobQueue::JobQueue(int worker_count) {
    for (int i = 0; i < worker_count; ++i) workers_.emplace_back([this] { work(); });
}

JobQueue::~JobQueue() {
    {
        std::lock_guard lock(mutex_);
        stop_ = true;
        jobs_.clear();
    }
    wake_.notify_all();
    for (auto& worker : workers_) worker.join();
}

void JobQueue::push(std::function<void()> job) {
    if (workers_.empty()) {
        job();
        return;
    }
    {
        std::lock_guard lock(mutex_);
        jobs_.push_back(std::move(job));
    }
    wake_.notify_one();
}

void JobQueue::wait_idle() {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [this] { return jobs_.empty() && running_ == 0; });
}

void JobQueue::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
        if (stop_) return;
        auto job = std::move(jobs_.front());
        jobs_.pop_front();
        ++running_;
        lock.unlock();
        job();
        lock.lock();
        --running_;
        if (jobs_.empty() && running_ == 0) idle_.notify_all();
    }
}

void parallel_ranges(int count, int smallest_range, const std::function<void(int, int)>& body) {
    const int cores = std::max(1u, std::thread::hardware_concurrency());
    const int parts = std::clamp(count / std::max(1, smallest_range), 1, cores);
    std::vector<std::thread> threads;
    const auto edge = [&](int i) { return static_cast<int>(int64_t(count) * i / parts); };
    for (int i = 1; i < parts; ++i) threads.emplace_back([&, i] { body(edge(i), edge(i + 1)); });
    body(edge(0), edge(1));
    for (auto& thread : threads) thread.join();
}

} // namespace loam
