// A process that edits is killed at any moment: every command that it reported is there afterwards, and
// verify() finds nothing. No thread may run when forking; the child never returns into GoogleTest.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include "document_fixture.h"

using namespace loam;
using namespace loam::test;

namespace {

struct Report {
    uint64_t sequence = 0;
    uint64_t applied = 0;  // commands not undone, after this one
};

// Applies commands until killed; every committed one goes through the pipe.
[[noreturn]] void edit_until_killed(const std::filesystem::path& folder, int pipe, uint32_t seed) {
    auto opened = Document::open(folder);
    if (!opened.ok()) _exit(2);
    Document& document = **opened;
    std::mt19937 random(seed);
    while (true) {
        const auto choice = random() % 10;
        bool done = false;
        if (choice == 0)
            done = document.undo().ok();
        else if (choice == 1)
            done = document.redo().ok();
        else
            done = document.apply(random_command(random, 40)).ok();
        if (!done) continue;
        const auto history = document.history(1 << 20);
        if (!history.ok()) _exit(3);
        Report report;
        for (const auto& entry : *history) {
            report.sequence = std::max(report.sequence, entry.sequence);
            report.applied += entry.applied;
        }
        if (write(pipe, &report, sizeof report) != sizeof report) _exit(4);
    }
}

}  // namespace

TEST(document_kill, every_reported_command_survives) {
    TemporaryFolder folder;
    const auto path = folder.path() / "p";
    create_small(path).reset();
    std::mt19937 random(1);
    int reports = 0;
    uint64_t last_count = 0;
    for (int round = 0; round < 50; ++round) {
        int ends[2];
        ASSERT_EQ(pipe(ends), 0);
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            close(ends[0]);
            edit_until_killed(path, ends[1], uint32_t(round));
        }
        close(ends[1]);
        std::this_thread::sleep_for(std::chrono::microseconds(10000 + random() % 150000));
        kill(child, SIGKILL);
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFSIGNALED(status)) << "the child ended by itself with " << WEXITSTATUS(status);
        Report report, last;
        bool any = false;
        while (read(ends[0], &report, sizeof report) == ssize_t(sizeof report))
            last = report, any = true, ++reports;
        close(ends[0]);

        const auto faults = take(Document::verify(path));
        ASSERT_TRUE(faults.empty()) << faults.front();
        const auto document = take(Document::open(path));
        uint64_t sequence = 0, applied = 0;
        for (const auto& entry : take(document->history(1 << 20))) {
            sequence = std::max(sequence, entry.sequence);
            applied += entry.applied;
        }
        if (any) {
            // At most one more was committed and not yet reported; it may have dropped undone ones or moved
            // by one.
            EXPECT_GE(sequence + 1, last.sequence);
            EXPECT_GE(applied + 1, last.applied);
            EXPECT_LE(applied, last.applied + 1);
            if (applied == last.applied) {
                EXPECT_EQ(sequence, last.sequence);
            }
        }
        last_count = applied;
    }
    EXPECT_GT(reports, 200) << "the test must have tested something";
    EXPECT_GT(last_count, 0u);
    // All of it can be taken back.
    const auto document = take(Document::open(path));
    while (document->can_undo()) ASSERT_TRUE(document->undo().ok());
    EXPECT_EQ(document->statistics().height_pages, 0u);
    EXPECT_TRUE(document->operators().empty());
}
