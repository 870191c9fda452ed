#include "editor/python/convert.h"

#include <cstring>

namespace loam::python {

void unwrap(const Status& status) {
    if (!status.ok()) throw PythonError(status.message());
}

Going keep_going(double, std::string_view) {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return Going::on;
}

py::object to_python(const Json& json) {
    switch (json.type()) {
        case Json::value_t::boolean:
            return py::bool_(json.get<bool>());
        case Json::value_t::number_integer:
            return py::int_(json.get<int64_t>());
        case Json::value_t::number_unsigned:
            return py::int_(json.get<uint64_t>());
        case Json::value_t::number_float:
            return py::float_(json.get<double>());
        case Json::value_t::string:
            return py::str(json.get_ref<const std::string&>());
        case Json::value_t::array: {
            py::list list;
            for (const Json& item : json) list.append(to_python(item));
            return list;
        }
        case Json::value_t::object: {
            py::dict dict;
            for (const auto& [key, value] : json.items()) dict[py::str(key)] = to_python(value);
            return dict;
        }
        default:
            return py::none();
    }
}

std::string command_line(const py::handle& command) {
    if (py::isinstance<py::str>(command)) return command.cast<std::string>();
    if (!py::isinstance<py::dict>(command)) throw py::type_error("a command is a dict or a string of JSON");
    // numpy's numbers are numbers, too: anything with .item() or .tolist() is unpacked.
    const py::object unpack = py::cpp_function([](const py::object& value) -> py::object {
        if (py::hasattr(value, "tolist")) return value.attr("tolist")();
        throw py::type_error("a command holds numbers, strings and lists, not " +
                             py::str(py::type::of(value).attr("__name__")).cast<std::string>());
    });
    return py::module_::import("json")
        .attr("dumps")(command, py::arg("default") = unpack)
        .cast<std::string>();
}

py::array_t<uint8_t> to_numpy(const Picture& picture) {
    py::array_t<uint8_t> out({py::ssize_t(picture.height), py::ssize_t(picture.width), py::ssize_t(4)});
    std::memcpy(out.mutable_data(), picture.rgba.data(), picture.rgba.size());
    return out;
}

Camera to_camera(const py::handle& camera, Session& session) {
    if (camera.is_none()) return session.default_camera();
    if (py::isinstance<Camera>(camera)) return camera.cast<Camera>();
    if (py::isinstance<py::str>(camera)) return unwrap(parse_camera(camera.cast<std::string>()));
    std::string text;
    for (const py::handle& number : py::reinterpret_borrow<py::sequence>(camera))
        text += (text.empty() ? "" : ",") +
                fmt::format("{}", py::float_(py::reinterpret_borrow<py::object>(number)).cast<double>());
    return unwrap(parse_camera(text));
}

}  // namespace loam::python
