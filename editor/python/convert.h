// Between Python and Loam: JSON, pictures, errors.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "editor/report.h"

namespace loam::python {

namespace py = pybind11;

struct PythonError : std::runtime_error {  // becomes loam.Error
    using std::runtime_error::runtime_error;
};

template <typename T>
T unwrap(Result<T> result) {
    if (!result.ok()) throw PythonError(result.message());
    return std::move(result).value();
}
void unwrap(const Status& status);

[[nodiscard]] py::object to_python(const Json& json);
// A dict or a string of JSON becomes the line that parse_command reads.
[[nodiscard]] std::string command_line(const py::handle& command);
[[nodiscard]] py::array_t<uint8_t> to_numpy(const Picture& picture);  // (height, width, 4)
// A Progress: Ctrl-C in Python cancels, by an exception.
Going keep_going(double share, std::string_view what);
// None, a text as on the command line, or a tuple (x, y, z, yaw_deg, pitch_deg[, fov_deg]).
[[nodiscard]] Camera to_camera(const py::handle& camera, Session& session);

}  // namespace loam::python
