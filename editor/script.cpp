#include "editor/script.h"

#include <fstream>

namespace loam {

Status run_script(const std::filesystem::path& file, const std::function<Status(const Command&)>& run) {
    std::error_code code;
    if (std::filesystem::is_directory(file, code))
        return error("{} is a folder, expected a script", file.string());
    std::ifstream stream(file);
    if (!stream) return error("cannot read the script {}", file.string());
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        const size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string::npos || line[first] == '#' || line.compare(first, 2, "//") == 0) continue;
        auto command = parse_command(line);
        if (!command) return error("{}:{}: {}", file.string(), number, command.message());
        if (auto status = run(*command); !status.ok())
            return error("{}:{}: {}", file.string(), number, status.message());
    }
    if (stream.bad()) return error("{} cannot be read to its end", file.string());
    return {};
}

}  // namespace loam
