// Reads every #include of the project and fails on an edge that the table of docs/architecture.md does not allow.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fs = std::filesystem;

namespace {

// Bottom up: a folder may include itself and the folders before it.
const std::vector<std::string> kOrder = {"runtime/base",
                                         "runtime/glsl",
                                         "runtime/gpu",
                                         "runtime/store",
                                         "runtime/document",
                                         "runtime/maps",
                                         "runtime/texture",
                                         "runtime/geometry",
                                         "runtime/scene",
                                         "runtime/frame",
                                         "ui",
                                         "editor",
                                         "tests"};

int rank_of(const std::string& path) {
    for (size_t i = 0; i < kOrder.size(); ++i)
        if (path.rfind(kOrder[i] + "/", 0) == 0) return int(i);
    return -1;
}

// Reasons why `file` may not include `included`; empty: it may.
std::string objection(const std::string& file, const std::string& included) {
    if (included.rfind("shaders/", 0) == 0) return {}; // shared headers include nothing of the runtime
    const int from = rank_of(file), to = rank_of(included);
    if (to < 0) return "is not a folder of the table";
    if (to > from) return "is above it";
    // The interface knows nothing of terrain; the document and store nothing of the device.
    if (file.rfind("ui/", 0) == 0 && to > 2 && included.rfind("ui/", 0) != 0)
        return "is terrain, and ui knows nothing of it";
    if ((from == 3 || from == 4) && to == 2) return "is the device, which store and document do not need";
    return {};
}

std::vector<std::pair<std::string, std::string>> includes_below(const fs::path& root) {
    static const std::regex pattern(R"re(^\s*#\s*include\s+"([^"]+)")re");
    std::vector<std::pair<std::string, std::string>> found;
    for (const char* top : {"runtime", "ui", "editor"})
        for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
            const auto extension = entry.path().extension();
            if (extension != ".h" && extension != ".cpp") continue;
            std::ifstream file(entry.path());
            std::smatch match;
            for (std::string line; std::getline(file, line);)
                if (std::regex_search(line, match, pattern))
                    found.emplace_back(fs::relative(entry.path(), root).string(), match[1]);
        }
    return found;
}

TEST(Layers, EveryIncludeFollowsTheTable) {
    const char* root = std::getenv("LOAM_SOURCE_DIR");
    ASSERT_NE(root, nullptr);
    const auto edges = includes_below(root);
    EXPECT_GT(edges.size(), 100u);
    for (const auto& [file, included] : edges)
        EXPECT_EQ(objection(file, included), "") << file << " includes " << included;
}

TEST(Layers, ForbiddenEdgesAreFound) {
    EXPECT_NE(objection("runtime/base/a.h", "runtime/gpu/device.h"), "");
    EXPECT_NE(objection("runtime/maps/a.h", "editor/session.h"), "");
    EXPECT_NE(objection("ui/a.h", "runtime/document/document.h"), "");
    EXPECT_NE(objection("runtime/document/a.h", "runtime/gpu/device.h"), "");
    EXPECT_EQ(objection("runtime/texture/a.cpp", "runtime/maps/index_map.h"), "");
    EXPECT_EQ(objection("ui/renderer.h", "runtime/gpu/device.h"), "");
}

} // namespace
