// The functions of decals in a project's folder, decals/NAME.glsl, and those that come with Loam, which are
// copied there when a decal first shows them: a project does not change with the program.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/document/decal_function.h"

namespace loam {

// Of each name the newest version that keeps to the rules is shown; while its text is being changed into one
// that does not, that stays. Any thread may call.
class FunctionLibrary {
  public:
    explicit FunctionLibrary(std::filesystem::path project) : project_(std::move(project)) {}
    [[nodiscard]] std::filesystem::path file_of(const std::string& name) const;
    [[nodiscard]] std::vector<std::string> names()
        const;  // the project's and those that come with Loam, sorted
    // As it is in the project, else as it comes with Loam, whether it compiles or not.
    [[nodiscard]] Result<std::string> text(const std::string& name) const;
    // The version shown, read when first asked for. The error names the functions there are.
    [[nodiscard]] Result<std::shared_ptr<const DecalFunction>> find(const std::string& name);
    // The same without looking at files: null when `find` has not found it.
    [[nodiscard]] std::shared_ptr<const DecalFunction> shown(const std::string& name) const;

    [[nodiscard]] bool in_use() const;  // something has asked for one

    Status keep(const std::string& name);  // one that comes with Loam becomes the project's
    // Compiles, saves and shows it.
    Status set(const std::string& name, std::string text);
    // A text that is being written and does not compile yet, decals/NAME.glsl.draft: kept when an editor is
    // closed, gone when something is set.
    [[nodiscard]] std::optional<std::string> draft(const std::string& name) const;
    Status keep_draft(const std::string& name, const std::string& text) const;
    void drop_draft(const std::string& name) const;
    // Whether its file has a text that is not shown, such as one that another program saved.
    std::vector<std::string> poll();  // names shown otherwise from now on

    // What is wrong with a function whose last text is not shown, or that a device did not take; by name.
    [[nodiscard]] std::map<std::string, std::string> errors() const;
    void report(const std::string& name, std::string message);
    // Texels that were drawn since its text is what it is where it gave no number.
    [[nodiscard]] std::map<std::string, uint64_t> failed_texels() const;
    void count_failed(const std::string& name, uint64_t texels);

  private:
    struct Entry {
        std::shared_ptr<const DecalFunction> shown;
        std::string seen;  // the file's text as it was last read
        std::filesystem::file_time_type time{};
        std::string error;
        uint64_t failed_texels = 0;
    };
    void show(Entry& entry, DecalFunction function);
    Status write(const std::filesystem::path& file, const std::string& text) const;

    std::filesystem::path project_;
    mutable std::mutex mutex_;
    std::map<std::string, Entry> entries_;
    uint64_t next_revision_ = 1;
};

}  // namespace loam
