#include "editor/cli/args.h"

#include <gtest/gtest.h>

namespace loam::cli {
namespace {

const std::vector<Positional> kPlaces{{"PROJECT", "project folder"}};
const std::vector<Option> kOptions{{"--size", ValueKind::size, "WxH", ""},
                                   {"--range", ValueKind::number, "LOW HIGH", "", 2},
                                   {"--json", ValueKind::none, "", ""},
                                   {"--camera", ValueKind::camera, "X,Y,Z,YAW,PITCH", ""},
                                   {"-o", ValueKind::text, "FILE", ""}};

Result<Args> parse(const std::vector<std::string>& words) {
    return parse_args(kPlaces, kOptions, words);
}

TEST(Args, options_may_stand_anywhere_and_take_values_either_way) {
    const auto args = parse({"--size=12x34", "valley", "-o", "a.png", "--json"});
    ASSERT_TRUE(args.ok()) << args.message();
    EXPECT_EQ(args->positional(0), "valley");
    EXPECT_EQ(args->size("--size", {}).width, 12);
    EXPECT_EQ(args->size("--size", {}).height, 34);
    EXPECT_EQ(args->text("-o"), "a.png");
    EXPECT_TRUE(args->has("--json"));
    EXPECT_FALSE(args->has("--range"));
    EXPECT_EQ(args->number("--range", 7), 7);
}

TEST(Args, negative_numbers_are_values) {
    const auto args = parse({"valley", "--range", "-5.5", "-1", "--camera", "-1,-2,3,0,-90"});
    ASSERT_TRUE(args.ok()) << args.message();
    EXPECT_EQ(args->number("--range", 0, 0), -5.5);
    EXPECT_EQ(args->number("--range", 0, 1), -1);
}

TEST(Args, an_unknown_option_names_itself_and_the_nearest) {
    const auto args = parse({"valley", "--sise", "3x3"});
    ASSERT_FALSE(args.ok());
    EXPECT_NE(args.message().find("--sise"), std::string::npos);
    EXPECT_NE(args.message().find("did you mean --size?"), std::string::npos);
    EXPECT_EQ(parse({"valley", "--entirely-else"}).message(), "unknown option --entirely-else");
}

TEST(Args, what_is_missing_or_too_much_is_named) {
    EXPECT_NE(parse({}).message().find("PROJECT"), std::string::npos);
    EXPECT_NE(parse({"a", "b"}).message().find("\"b\""), std::string::npos);
    EXPECT_NE(parse({"a", "--range", "1"}).message().find("--range"), std::string::npos);
    EXPECT_NE(parse({"a", "--json=1"}).message().find("--json"), std::string::npos);
    EXPECT_NE(parse({"a", "--json", "--json"}).message().find("twice"), std::string::npos);
}

TEST(Args, values_are_checked_when_parsed) {
    EXPECT_FALSE(parse({"a", "--size", "12"}).ok());
    EXPECT_FALSE(parse({"a", "--size", "0x5"}).ok());
    EXPECT_FALSE(parse({"a", "--size", "5x99999"}).ok());
    EXPECT_FALSE(parse({"a", "--range", "1", "two"}).ok());
    EXPECT_FALSE(parse({"a", "--range", "1", "nan"}).ok());
    EXPECT_FALSE(parse({"a", "--camera", "1,2,3"}).ok());
}

TEST(Args, two_dashes_end_the_options) {
    const auto args = parse({"--", "--odd-name"});
    ASSERT_TRUE(args.ok()) << args.message();
    EXPECT_EQ(args->positional(0), "--odd-name");
}

TEST(Args, nearest_word_is_empty_when_none_is_close) {
    const std::vector<std::string> words{"render", "replay", "info"};
    EXPECT_EQ(nearest_word("rendr", words), "render");
    EXPECT_EQ(nearest_word("xyzzyq", words), "");
}

}  // namespace
}  // namespace loam::cli
