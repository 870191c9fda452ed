// loam.Project: an open project as Python sees it.
#pragma once

#include <memory>
#include <string>

#include "editor/python/convert.h"

namespace loam::python {

class Project {
  public:
    Project(const std::string& path, const std::string& device, bool read_only, bool validation,
            const std::string& quality, const std::string& format, const py::dict& settings);

    [[nodiscard]] Session& session();  // raises once closed
    void close() { session_.reset(); }
    [[nodiscard]] bool closed() const { return session_ == nullptr; }
    py::object apply(const py::handle& command);
    py::object apply_json(const Json& command);

  private:
    std::unique_ptr<Session> session_;
};

void bind_project(py::module_& module);

}  // namespace loam::python
