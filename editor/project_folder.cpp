#include "editor/project_folder.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace loam {

namespace fs = std::filesystem;

fs::path free_file(const fs::path& folder, const std::string& name,
                   std::initializer_list<const char*> suffixes) {
    std::string stem = name.empty() ? "unnamed" : name;
    for (char& c : stem) {
        const auto u = static_cast<unsigned char>(c);
        if (u < 0x80 && !std::isalnum(u) && c != '-' && c != '_') c = '_';
    }
    std::string free = stem;
    const auto taken = [&] {
        std::error_code ignored;
        return std::any_of(suffixes.begin(), suffixes.end(),
                           [&](const char* suffix) { return fs::exists(folder / (free + suffix), ignored); });
    };
    for (int i = 2; taken(); ++i) free = stem + "-" + std::to_string(i);
    return folder / (free + *suffixes.begin());
}

Result<NewFolder> NewFolder::create(const fs::path& target) {
    std::error_code code;
    const fs::path whole = fs::absolute(target, code).lexically_normal();
    // "folder/" names the folder, too.
    const fs::path place = whole.has_filename() ? whole : whole.parent_path();
    if (fs::exists(place, code) && !(fs::is_directory(place, code) && fs::is_empty(place, code)))
        return error("{} exists already: choose another folder or remove it", target.string());
    const fs::path parent = place.parent_path();
    if (fs::exists(parent, code) && !fs::is_directory(parent, code))
        return error("cannot create {}: {} is not a folder", target.string(), parent.string());
    fs::create_directories(parent, code);
    if (code) return error("cannot create the folder {}: {}", parent.string(), code.message());

    NewFolder folder;
    folder.target_ = place;
    const fs::path temporary = parent / fmt::format(".{}.part-{}", place.filename().string(), ::getpid());
    fs::remove_all(temporary, code);
    if (!fs::create_directory(temporary, code))
        return error("cannot create {}: {}", target.string(), code.message());
    folder.temporary_ = temporary;
    return folder;
}

NewFolder::NewFolder(NewFolder&& other) noexcept
    : target_(std::move(other.target_)), temporary_(std::exchange(other.temporary_, {})) {}

NewFolder::~NewFolder() {
    std::error_code code;
    if (!temporary_.empty()) fs::remove_all(temporary_, code);
}

Status NewFolder::keep() {
    std::error_code code;
    fs::rename(temporary_, target_, code);
    if (code) return error("cannot move the finished project to {}: {}", target_.string(), code.message());
    temporary_.clear();
    return {};
}

}  // namespace loam
