#include "runtime/document/stamp_library.h"

#include <algorithm>

#include "runtime/store/stamp_file.h"

namespace loam {

namespace {
constexpr const char* kFolder = "stamps";
constexpr const char* kSuffix = ".stamp";
}  // namespace

Status check_stamp_name(const std::string& name) {
    constexpr size_t kLongest = 100;
    const auto plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-' || c == '.' || c == ' ';
    };
    if (name.empty() || name.size() > kLongest || name[0] == '.' ||
        !std::all_of(name.begin(), name.end(), plain))
        return error("\"{}\" is no name of a stamp: 1 to {} letters, digits, spaces and . _ -, no dot first",
                     name, kLongest);
    return {};
}

std::filesystem::path StampLibrary::file_of(const std::string& name) const {
    return project_ / kFolder / (name + kSuffix);
}

std::vector<std::string> StampLibrary::names() const {
    std::vector<std::string> names;
    std::error_code ignored;  // no folder: no stamps
    for (const auto& entry : std::filesystem::directory_iterator(project_ / kFolder, ignored))
        if (entry.path().extension() == kSuffix) names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

Result<std::shared_ptr<const StampImage>> StampLibrary::find(const std::string& name) {
    LOAM_TRY(check_stamp_name(name));
    const std::lock_guard lock(mutex_);
    std::weak_ptr<const StampImage>& kept = loaded_[name];
    if (auto image = kept.lock()) return last_ = image;
    if (!std::filesystem::exists(file_of(name))) {
        std::string known;
        for (const std::string& other : names()) known += (known.empty() ? "" : ", ") + other;
        return error("unknown stamp \"{}\" (known: {}); loam stamp makes one of a picture", name,
                     known.empty() ? "none" : known);
    }
    auto loaded = load_stamp(file_of(name));
    if (!loaded.ok()) return loaded.error();
    auto image = std::make_shared<const StampImage>(std::move(*loaded));
    kept = last_ = image;
    return image;
}

}  // namespace loam
