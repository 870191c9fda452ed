#include "runtime/gpu/shader_library.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>

#include "runtime/gpu/embedded_shaders.h"

namespace loam::gpu {

namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// The file and, through their #include lines, all files it takes in.
void collect_files(const fs::path& root, const fs::path& file, std::vector<fs::path>& out) {
    if (std::ranges::find(out, file) != out.end()) return;
    out.push_back(file);
    const std::string text = read_text(file);
    for (size_t at = text.find("#include"); at != std::string::npos; at = text.find("#include", at + 1)) {
        const size_t open = text.find_first_of("\"\n", at), close = text.find_first_of("\"\n", open + 1);
        if (open == std::string::npos || close == std::string::npos || text[open] == '\n') continue;
        const std::string name = text.substr(open + 1, close - open - 1);
        for (const fs::path& candidate : {file.parent_path() / name, root.parent_path() / name})
            if (std::error_code failed; fs::is_regular_file(candidate, failed)) {
                collect_files(root, candidate.lexically_normal(), out);
                break;
            }
    }
}

std::vector<fs::file_time_type> times_of(const std::vector<fs::path>& files) {
    std::vector<fs::file_time_type> times;
    for (const fs::path& file : files) {
        std::error_code failed; // an editor may be replacing the file just now
        times.push_back(fs::last_write_time(file, failed));
    }
    return times;
}

std::vector<std::string> shader_names(const fs::path& root) {
    std::vector<std::string> names;
    std::error_code failed;
    for (auto it = fs::recursive_directory_iterator(root, failed); !failed && it != fs::end(it);
         it.increment(failed)) {
        const fs::path extension = it->path().extension();
        if (extension == ".comp" || extension == ".vert" || extension == ".frag")
            names.push_back(it->path().lexically_relative(root).generic_string());
    }
    return names;
}

}  // namespace

Result<std::span<const uint32_t>> ShaderLibrary::spirv(std::string_view name) const {
    if (const auto it = reloaded_.find(name); it != reloaded_.end())
        return std::span<const uint32_t>(it->second);
    const auto embedded = embedded_shaders();
    const auto it = std::ranges::find(embedded, name, &EmbeddedShader::name);
    if (it == embedded.end()) return error("there is no shader {}", name);
    return it->words;
}

void ShaderLibrary::watch(const fs::path& shader_root) {
    root_ = shader_root.lexically_normal();
    if (!root_.has_filename()) root_ = root_.parent_path();  // "shaders/"
    watched_.clear();
    for (const std::string& name : shader_names(root_)) {
        Watched entry;
        collect_files(root_, root_ / name, entry.files);
        entry.times = times_of(entry.files);
        watched_.emplace(name, std::move(entry));
    }
}

bool ShaderLibrary::poll_one(const std::string& name, const std::string& base) {
    Watched& entry = watched_[name];  // a new file has no files yet and counts as changed
    if (!entry.files.empty() && times_of(entry.files) == entry.times) return false;
    entry.files.clear();
    collect_files(root_, root_ / base, entry.files);
    entry.times = times_of(entry.files);
    return recompile(name);
}

std::vector<std::string> ShaderLibrary::poll() {
    std::vector<std::string> changed;
    if (root_.empty()) return changed;
    for (const std::string& name : shader_names(root_))
        if (poll_one(name, name)) changed.push_back(name);
    for (const auto& [name, made] : made_)
        if (poll_one(name, made.base)) changed.push_back(name);
    return changed;
}

Status ShaderLibrary::make(const std::string& name, const std::string& base, glsl::Texts texts) {
    Made made{base, std::move(texts)};
    auto words = compile_made(made);
    if (!words) return words.error();
    reloaded_[name] = std::move(*words);
    made_[name] = std::move(made);
    if (root_.empty()) return {};
    Watched& entry = watched_[name];
    entry.files.clear();
    collect_files(root_, root_ / base, entry.files);
    entry.times = times_of(entry.files);
    return {};
}

bool ShaderLibrary::recompile(const std::string& name) {
    const auto made = made_.find(name);
    auto words = made != made_.end() ? compile_made(made->second)
                                     : glsl::compile(name, read_text(root_ / name),
                                                     glsl::reader_of_files(root_.parent_path()));
    if (!words) {
        errors_[name] = words.message();
        return false;
    }
    errors_.erase(name);
    if (const auto before = spirv(name); before.ok() && std::ranges::equal(*before, *words)) return false;
    reloaded_[name] = std::move(*words);
    return true;
}

Result<glsl::Words> ShaderLibrary::compile_made(const Made& made) const {
    return glsl::compile_with(
        made.base, made.texts,
        root_.empty() ? glsl::Reader(glsl::embedded_text) : glsl::reader_of_files(root_.parent_path()));
}

}  // namespace loam::gpu
