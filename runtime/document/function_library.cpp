#include "runtime/document/function_library.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>

#include "runtime/base/log.h"
#include "runtime/store/packed_file.h"

namespace loam {

namespace {

constexpr const char* kFolder = "decals";
constexpr const char* kSuffix = ".glsl";
constexpr const char* kDraft = ".glsl.draft";

std::optional<std::string> read_file(const std::filesystem::path& path) {
    std::error_code none;
    if (!std::filesystem::is_regular_file(path, none)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    // One byte more than a text may have, and no more of whatever the file is.
    std::string text(kLargestFunction_bytes + 1, '\0');
    file.read(text.data(), std::streamsize(text.size()));
    text.resize(size_t(file.gcount()));
    return text;
}

std::optional<std::string> shipped(const std::string& name) {
    for (const auto& [known, text] : shipped_functions())
        if (known == name) return text;
    return std::nullopt;
}

std::filesystem::file_time_type time_of(const std::filesystem::path& path) {
    std::error_code none;
    return std::filesystem::last_write_time(path, none);
}

}  // namespace

std::filesystem::path FunctionLibrary::file_of(const std::string& name) const {
    return project_ / kFolder / (name + kSuffix);
}

std::vector<std::string> FunctionLibrary::names() const {
    std::vector<std::string> names;
    for (const auto& [name, text] : shipped_functions()) names.push_back(name);
    std::error_code ignored;  // no folder: none of its own
    for (const auto& entry : std::filesystem::directory_iterator(project_ / kFolder, ignored))
        if (entry.path().extension() == kSuffix && check_function_name(entry.path().stem().string()))
            names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

Result<std::string> FunctionLibrary::text(const std::string& name) const {
    LOAM_TRY(check_function_name(name));
    if (auto text = read_file(file_of(name))) return std::move(*text);
    if (auto text = shipped(name)) return std::move(*text);
    std::string known;
    for (const std::string& other : names()) known += (known.empty() ? "" : ", ") + other;
    return error("unknown function \"{}\" (known: {})", name, known);
}

Result<std::shared_ptr<const DecalFunction>> FunctionLibrary::find(const std::string& name) {
    if (auto known = shown(name)) return known;
    const auto time = time_of(file_of(name));
    {
        const std::lock_guard lock(mutex_);
        const auto known = entries_.find(name);
        // A text at fault is not compiled again and again.
        if (known != entries_.end() && !known->second.error.empty() && known->second.time == time)
            return Error{known->second.error};
    }
    auto found = text(name);
    if (!found.ok()) return found.error();
    auto function = read_function(name, *found);
    const Status compiled = function.ok() ? compile_function(*function) : function.error();
    const std::lock_guard lock(mutex_);
    Entry& entry = entries_[name];
    entry.seen = std::move(*found);
    entry.time = time;
    if (!compiled.ok()) {
        entry.error = compiled.message();
        return compiled.error();
    }
    if (!entry.shown) show(entry, std::move(*function));
    return entry.shown;
}

std::shared_ptr<const DecalFunction> FunctionLibrary::shown(const std::string& name) const {
    const std::lock_guard lock(mutex_);
    const auto it = entries_.find(name);
    return it == entries_.end() ? nullptr : it->second.shown;
}

bool FunctionLibrary::in_use() const {
    const std::lock_guard lock(mutex_);
    return !entries_.empty();
}

void FunctionLibrary::show(Entry& entry, DecalFunction function) {
    function.revision = next_revision_++;
    entry.shown = std::make_shared<const DecalFunction>(std::move(function));
    entry.error.clear();
    entry.failed_texels = 0;
}

Status FunctionLibrary::write(const std::filesystem::path& file, const std::string& text) const {
    std::error_code failure;
    std::filesystem::create_directories(project_ / kFolder, failure);
    if (failure)
        return error("cannot make the folder {}: {}", (project_ / kFolder).string(), failure.message());
    return replace_file(file, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

std::optional<std::string> FunctionLibrary::draft(const std::string& name) const {
    return read_file(project_ / kFolder / (name + kDraft));
}

Status FunctionLibrary::keep_draft(const std::string& name, const std::string& text) const {
    LOAM_TRY(check_function_name(name));
    return write(project_ / kFolder / (name + kDraft), text);
}

void FunctionLibrary::drop_draft(const std::string& name) const {
    std::error_code none;
    std::filesystem::remove(project_ / kFolder / (name + kDraft), none);
}

Status FunctionLibrary::keep(const std::string& name) {
    std::error_code failure;
    if (std::filesystem::exists(file_of(name), failure)) return {};
    const auto text = shipped(name);
    if (!text) return {};
    LOAM_TRY(write(file_of(name), *text));
    const std::lock_guard lock(mutex_);
    if (const auto it = entries_.find(name); it != entries_.end()) it->second.time = time_of(file_of(name));
    return {};
}

Status FunctionLibrary::set(const std::string& name, std::string text) {
    auto function = read_function(name, text);
    if (!function.ok()) return function.error();
    LOAM_TRY(compile_function(*function));
    LOAM_TRY(write(file_of(name), text));
    drop_draft(name);
    const std::lock_guard lock(mutex_);
    Entry& entry = entries_[name];
    entry.seen = std::move(text);
    entry.time = time_of(file_of(name));
    show(entry, std::move(*function));
    return {};
}

std::vector<std::string> FunctionLibrary::poll() {
    std::vector<std::string> names, changed;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [name, entry] : entries_)
            if (time_of(file_of(name)) != entry.time) names.push_back(name);
    }
    for (const std::string& name : names) {
        const auto time = time_of(file_of(name));
        const auto text = read_file(file_of(name));
        const auto function = text ? read_function(name, *text)
                                   : Result<DecalFunction>(error("{} is gone", file_of(name).string()));
        const Status compiled = function.ok() ? compile_function(*function) : function.error();
        const std::lock_guard lock(mutex_);
        Entry& entry = entries_[name];
        entry.time = time;
        if (text && *text == entry.seen) continue;
        entry.seen = text.value_or("");  // one that is gone may come back as it was
        if (!compiled.ok()) {
            entry.error = compiled.message();
        } else {
            show(entry, *function);
            changed.push_back(name);
        }
    }
    return changed;
}

std::map<std::string, std::string> FunctionLibrary::errors() const {
    std::map<std::string, std::string> errors;
    const std::lock_guard lock(mutex_);
    for (const auto& [name, entry] : entries_)
        if (!entry.error.empty()) errors[name] = entry.error;
    return errors;
}

void FunctionLibrary::report(const std::string& name, std::string message) {
    log(LogLevel::warning, "decals of {} are not shown: {}", name, message);
    const std::lock_guard lock(mutex_);
    entries_[name].error = std::move(message);
}

std::map<std::string, uint64_t> FunctionLibrary::failed_texels() const {
    std::map<std::string, uint64_t> failed;
    const std::lock_guard lock(mutex_);
    for (const auto& [name, entry] : entries_)
        if (entry.failed_texels > 0) failed[name] = entry.failed_texels;
    return failed;
}

void FunctionLibrary::count_failed(const std::string& name, uint64_t texels) {
    bool first = false;
    {
        const std::lock_guard lock(mutex_);
        Entry& entry = entries_[name];
        first = entry.failed_texels == 0;
        entry.failed_texels += texels;
    }
    if (first)
        log(LogLevel::warning,
            "the decals' function {} gave no number (NaN or infinite) at {} texels; they stay as they are",
            name, texels);
}

}  // namespace loam
