// Places for new files of a project.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

#include "runtime/base/result.h"

namespace loam {

// Where a file of this name may be made: letters and digits of any script stay, what file systems or shells
// take amiss becomes "_", and where any of the suffixes is taken a number is added. The path has the first
// suffix.
[[nodiscard]] std::filesystem::path free_file(const std::filesystem::path& folder, const std::string& name,
                                              std::initializer_list<const char*> suffixes);

// A project folder that appears whole or not at all: it is made beside its place under another name and
// renamed at the end.
class NewFolder {
  public:
    // Refuses a target that exists (an empty folder is accepted) and a parent that does not or cannot be
    // written.
    static Result<NewFolder> create(const std::filesystem::path& target);
    NewFolder(NewFolder&& other) noexcept;
    NewFolder& operator=(NewFolder&&) = delete;
    ~NewFolder();  // removes what was not kept

    [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }
    [[nodiscard]] std::string name() const { return target_.filename().string(); }  // of the folder to be
    // Everything in it is closed by now.
    Status keep();

  private:
    NewFolder() = default;
    std::filesystem::path target_, temporary_;
};

}  // namespace loam
