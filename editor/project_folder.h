// A project folder that appears whole or not at all: it is made beside its place under another name and
// renamed at the end.
#pragma once

#include <filesystem>
#include <string>

#include "runtime/base/result.h"

namespace loam {

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
