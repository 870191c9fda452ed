// import loam: the same commands, queries and pictures as the window, for scripts and tests.
#include <pybind11/stl.h>

#include "editor/import.h"
#include "editor/new_project.h"
#include "editor/python/project.h"
#include "editor/settings.h"
#include "runtime/frame/debug_views.h"

namespace loam::python {

namespace {

void new_project(const std::string& path, const std::string& recipe, double size_m, uint32_t seed,
                 int layer_size) {
    const py::gil_scoped_release release;
    unwrap(create_project({path, {recipe, size_m, seed}, layer_size}, keep_going));
}

py::object import_project(const std::string& heights, const std::string& path, double spacing_m,
                          const py::object& range_m, const py::object& step_m, double offset_m,
                          const py::object& fill_nan_m, int layer_size) {
    ImportRequest request{.heights = heights,
                          .project = path,
                          .spacing_m = spacing_m,
                          .scale = {},
                          .fill_nan_m = {},
                          .crop = {},
                          .layer_size_texels = layer_size};
    if (!range_m.is_none()) {
        const auto range = range_m.cast<std::pair<double, double>>();
        request.scale.has_range = true;
        request.scale.range_low_m = range.first;
        request.scale.range_high_m = range.second;
    }
    if (!step_m.is_none()) {
        request.scale.has_step = true;
        request.scale.step_m = step_m.cast<double>();
        request.scale.offset_m = offset_m;
    }
    if (!fill_nan_m.is_none()) request.fill_nan_m = fill_nan_m.cast<double>();
    ImportReport report;
    {
        const py::gil_scoped_release release;
        report = unwrap(import_heights(request, keep_going));
    }
    return to_python(Json{{"samples", {report.width, report.height}},
                          {"min_m", report.min_m},
                          {"max_m", report.max_m},
                          {"notes", report.diagnosis.notes},
                          {"warnings", report.diagnosis.warnings}});
}

}  // namespace

}  // namespace loam::python

PYBIND11_MODULE(loam, module) {
    using namespace loam::python;
    module.doc() = "Loam: open terrain projects, edit them with commands, query and render them.";
    py::register_exception<PythonError>(module, "Error", PyExc_RuntimeError);
    bind_project(module);
    module.def("new", &new_project, "Makes an example project from a recipe.", py::arg("path"),
               py::arg("recipe") = "valley", py::arg("size_m") = 4096.0, py::arg("seed") = 1,
               py::arg("layer_size") = 1024);
    module.def("import_heights", &import_project,
               "Makes a project from a picture of heights; returns what was found in it.", py::arg("heights"),
               py::arg("path"), py::arg("spacing_m") = 1.0, py::arg("range_m") = py::none(),
               py::arg("step_m") = py::none(), py::arg("offset_m") = 0.0, py::arg("fill_nan_m") = py::none(),
               py::arg("layer_size") = 1024);
    module.def(
        "open",
        [](const std::string& path, const std::string& device, bool read_only, bool validation,
           const std::string& quality, const std::string& format, const py::dict& settings) {
            return std::make_unique<Project>(path, device, read_only, validation, quality, format, settings);
        },
        "Opens a project.", py::arg("path"), py::arg("device") = "", py::arg("read_only") = false,
        py::arg("validation") = false, py::arg("quality") = "", py::arg("format") = "",
        py::arg("settings") = py::dict());
    module.def(
        "settings",
        [] {
            loam::Json list = loam::Json::array();
            for (const loam::SettingText& s : loam::list_settings({}))
                list.push_back({{"name", s.name}, {"value", s.value}, {"range", s.range}, {"help", s.help}});
            return to_python(list);
        },
        "The figures that open(settings={name: value}) changes, with their defaults.");
    module.def(
        "debug_views",
        [] {
            std::vector<std::string> names;
            for (const loam::DebugViewInfo& view : loam::debug_views()) names.emplace_back(view.name);
            return names;
        },
        "What render(debug=…) takes.");
    module.def(
        "verify",
        [](const std::string& path) { return to_python(loam::Json(unwrap(loam::Document::verify(path)))); },
        "Reads everything in a project and returns its faults, one sentence each.", py::arg("path"));
}
