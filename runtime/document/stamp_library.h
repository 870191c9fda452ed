// The pictures of stamps in a project's folder.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

struct StampImage;

// A file's name of letters, digits, spaces, and . _ - inside: nothing that could leave the folder.
[[nodiscard]] Status check_stamp_name(const std::string& name);

// The stamps of a project's folder. Pictures are loaded when first asked for and kept while a stamp shows
// them.
class StampLibrary {
  public:
    explicit StampLibrary(std::filesystem::path project) : project_(std::move(project)) {}
    [[nodiscard]] std::filesystem::path file_of(const std::string& name) const;
    [[nodiscard]] std::vector<std::string> names() const;  // sorted
    // The error names the stamps there are.
    [[nodiscard]] Result<std::shared_ptr<const StampImage>> find(const std::string& name);

  private:
    std::filesystem::path project_;
    std::mutex mutex_;
    std::map<std::string, std::weak_ptr<const StampImage>> loaded_;
    std::shared_ptr<const StampImage> last_;  // that nothing shows it yet does not load it again
};

}  // namespace loam
