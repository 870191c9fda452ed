// A fill in squares: watched, stopped, failing, undone as one. No device is needed.
#include "editor/fill.h"

#include "document_fixture.h"
#include "editor/session.h"
#include "index_texels.h"

namespace {

using namespace loam;
using namespace loam::test;

FillCommand all_of(const char* layer) {
    FillCommand command;
    command.layer = layer;
    return command;
}

struct Opened {
    TemporaryFolder folder;
    std::unique_ptr<Session> session;
    Opened() {
        create_small(folder.path() / "p").reset();
        session = take(Session::open(folder.path() / "p", {}));
        PaintCommand paint;
        paint.dabs = {{40, 40}};
        paint.radius_m = 20;
        paint.layer = "dirt";
        EXPECT_TRUE(session->apply({.body = paint, .group = 7}).ok());
    }
};

TEST(Fill, SquareBySquareIsTheWholeAndOneStep) {
    Opened of;
    const auto before = read_layers(of.session->document());
    Fill fill(*of.session, all_of("scree"));
    int steps = 0;
    for (; !fill.done(); ++steps) {
        EXPECT_EQ(fill.share(), steps * 0.5);  // 602 x 414 texels
        ASSERT_TRUE(fill.step().ok());
    }
    EXPECT_EQ(steps, 2);
    EXPECT_EQ(read_layers(of.session->document()), std::vector<int>(before.size(), 2));
    ASSERT_TRUE(of.session->apply({UndoCommand{}}).ok());
    EXPECT_EQ(read_layers(of.session->document()), before);
}

TEST(Fill, CancelledLeavesTheMapAndTheHistoryAsTheyWere) {
    Opened of;
    const auto before = read_layers(of.session->document());
    {
        Fill fill(*of.session, all_of("scree"));
        ASSERT_TRUE(fill.step().ok());
        EXPECT_NE(read_layers(of.session->document()), before) << "there is something to take back";
        ASSERT_TRUE(fill.cancel().ok());
        EXPECT_TRUE(fill.done());
    }
    EXPECT_EQ(read_layers(of.session->document()), before);
    // Nothing was changed, so nothing is undone: the stroke before it stays.
    FillCommand nothing = all_of("scree");
    nothing.rect = WorldRect{-50, -50, -10, -10};
    nothing.replace = "scree";
    Fill idle(*of.session, nothing);
    EXPECT_TRUE(idle.done());
    ASSERT_TRUE(idle.cancel().ok());
    EXPECT_EQ(read_layers(of.session->document()), before);
    ASSERT_TRUE(of.session->apply({UndoCommand{}}).ok());
    EXPECT_NE(read_layers(of.session->document()), before) << "the next undo is the stroke's";
}

TEST(Fill, AnErrorTakesNothingElseBack) {
    Opened of;
    const auto before = read_layers(of.session->document());
    FillCommand wrong = all_of("scree");
    wrong.replace = "lava";
    Fill fill(*of.session, wrong);
    const auto dirt = fill.step();
    ASSERT_FALSE(dirt.ok());
    EXPECT_NE(dirt.message().find("unknown layer \"lava\""), std::string::npos);
    EXPECT_TRUE(fill.done());
    EXPECT_EQ(read_layers(of.session->document()), before);
}

}  // namespace
