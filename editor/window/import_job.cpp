#include "editor/window/import_job.h"

#include <sys/resource.h>

namespace loam::window {

namespace {

constexpr int kNice = 10; // the frames come first where cores are few

} // namespace

ImportJob::ImportJob(Steps steps) : steps_(std::move(steps)) {
    thread_ = std::thread([this] {
        // On Linux of the thread alone and of those that it starts.
        (void)setpriority(PRIO_PROCESS, 0, kNice);
        const Status made = steps_.make([this](double share, std::string_view what) {
            const std::lock_guard lock(mutex_);
            stand_ = {share, std::string(what)};
            return cancelled_ ? Going::cancel : Going::on;
        });
        made_ = made;
        done_ = true;
    });
}

ImportJob::~ImportJob() {
    cancel();
    if (thread_.joinable()) thread_.join();
}

ImportJob::Stand ImportJob::stand() const {
    const std::lock_guard lock(mutex_);
    return stand_;
}

Status ImportJob::finish() {
    thread_.join();
    LOAM_TRY(made_);
    return steps_.adopt();
}

} // namespace loam::window
