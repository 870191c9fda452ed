// The renderer's figures by name.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "editor/settings.h"

namespace {

using namespace loam;

TEST(Settings, TheDefaultsAreTheTalksFigures) {
    std::map<std::string, std::string> values;
    for (const SettingText& s : list_settings({})) values[s.name] = s.value;
    EXPECT_EQ(values["texture.cache_divisor"], "3");
    EXPECT_EQ(values["texture.first_retry_frames"], "15");
    EXPECT_EQ(values["texture.last_retry_frames"], "60");
    EXPECT_EQ(values["texture.age_frames"], "3");
    EXPECT_EQ(values["texture.max_live_sectors"], "255");
    EXPECT_EQ(values["texture.feedback"], "grid");
    EXPECT_EQ(values["texture.hidden_depth"], "4"); // a sixteenth of the image
}

TEST(Settings, EveryOneTakesItsOwnValueAndIsReadBack) {
    for (const SettingText& s : list_settings({})) {
        RendererDesc desc;
        EXPECT_TRUE(change_setting(desc, s.name, s.value).ok()) << s.name;
        const std::string other = s.name == "texture.feedback" ? "eighth" : s.name.ends_with("pages") ? "16" : "1";
        ASSERT_TRUE(change_setting(desc, s.name, other).ok()) << s.name;
        int differ = 0;
        for (const SettingText& now : list_settings(desc)) {
            if (now.name == s.name) EXPECT_EQ(now.value, other) << s.name;
            else differ += now.value != [&] {
                for (const SettingText& was : list_settings({}))
                    if (was.name == now.name) return was.value;
                return std::string();
            }();
        }
        EXPECT_EQ(differ, 0) << s.name << " changes another one";
    }
}

TEST(Settings, AListIsTakenWhollyOrNotAtAll) {
    RendererDesc desc;
    ASSERT_TRUE(change_settings(desc, "texture.budget_pages=4,texture.budget_ms=2.5").ok());
    EXPECT_EQ(desc.texture.budget_pages, 4);
    EXPECT_EQ(desc.texture.budget_ms, 2.5);
    EXPECT_FALSE(change_settings(desc, "texture.budget_pages=9,texture.budget_ms=fast").ok());
    EXPECT_EQ(desc.texture.budget_pages, 4);
    EXPECT_TRUE(change_settings(desc, "").ok());
}

TEST(Settings, MistakesAreNamed) {
    RendererDesc desc;
    const auto message = [&](const char* text) {
        const Status status = change_settings(desc, text);
        return status.ok() ? std::string() : status.message();
    };
    EXPECT_EQ(message("texture.budget_page=4"), "unknown setting \"texture.budget_page\", did you mean texture.budget_pages?");
    EXPECT_NE(message("qwertyuiop=4").find("loam info --settings"), std::string::npos);
    EXPECT_NE(message("texture.budget_pages").find("NAME=VALUE"), std::string::npos);
    EXPECT_EQ(message("texture.cache_divisor=0"), "texture.cache_divisor is 1 … 64, not 0");
    EXPECT_NE(message("texture.budget_pages=2.5"), "");
    EXPECT_NE(message("texture.budget_ms=nan"), "");
    EXPECT_NE(message("texture.feedback=half").find("grid, eighth, every_pixel"), std::string::npos);
}

} // namespace
