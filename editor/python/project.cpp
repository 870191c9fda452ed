#include "editor/python/project.h"
#include "editor/stamp_import.h"

#include <array>
#include <cmath>
#include <optional>

#include <pybind11/stl.h>

#include "editor/choices.h"
#include "editor/settings.h"
#include "editor/settings_text.h"
#include "runtime/document/operator_json.h"
#include "runtime/document/spline_path.h"

namespace loam::python {

namespace {

// f(x, y) for numbers or arrays that broadcast against each other.
template <typename F>
py::object over_points(const py::object& x, const py::object& y, F&& f) {
    using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
    return py::vectorize([&f](double px, double py_) { return f(px, py_); })(Array(x), Array(y));
}

py::object height(Project& p, const py::object& x, const py::object& y) {
    return over_points(x, y, [&](double px, double py_) { return unwrap(p.session().height_m(px, py_)); });
}

py::object is_cut(Project& p, const py::object& x, const py::object& y) {
    return over_points(x, y, [&](double px, double py_) { return p.session().is_cut(px, py_); });
}

py::object layer(Project& p, const py::object& x, const py::object& y) {
    return over_points(
        x, y, [&](double px, double py_) { return int(unwrap(p.session().layer_at(px, py_)).layer); });
}

// (…, 3)
py::object normal(Project& p, const py::object& x, const py::object& y) {
    py::list parts;
    for (int axis = 0; axis < 3; ++axis)
        parts.append(over_points(
            x, y, [&](double px, double py_) { return unwrap(p.session().normal(px, py_))[axis]; }));
    return py::module_::import("numpy").attr("stack")(parts, py::arg("axis") = -1);
}

py::object ray_cast(Project& p, const std::array<double, 3>& origin, const std::array<double, 3>& direction,
                    double max_m) {
    const glm::dvec3 d(direction[0], direction[1], direction[2]);
    const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    if (!(length > 0)) throw PythonError("the direction of a ray has no length");
    const auto hit = unwrap(p.session().ray_cast({origin[0], origin[1], origin[2]}, d / length, max_m));
    if (!hit) return py::none();
    return py::make_tuple(hit->x, hit->y, hit->z);
}

py::array_t<uint8_t> render(Project& p, const py::object& camera, std::pair<int, int> size, bool reference,
                            int supersample, const std::string& debug, double render_scale, int max_frames,
                            const std::string& filter) {
    Session& session = p.session();
    RenderRequest request;
    request.camera = to_camera(camera, session);
    request.width = size.first;
    request.height = size.second;
    if (size.first < 1 || size.second < 1 || size.first > 16384 || size.second > 16384)
        throw PythonError(
            fmt::format("size {}x{} is outside 1 … 16384 pixels a side", size.first, size.second));
    request.reference = reference;
    request.supersample = supersample;
    request.max_frames = max_frames;
    request.frame.render_scale = static_cast<float>(render_scale);
    request.frame.debug = unwrap(parse_debug_view(debug));
    request.frame.filter = unwrap(parse_filter(filter));
    Picture picture;
    {
        const py::gil_scoped_release release;
        picture = unwrap(session.render(request));
    }
    return to_numpy(picture);
}

void step(Project& p, const py::object& camera, int n, std::pair<int, int> size, double render_scale,
          bool moving, const std::string& debug) {
    Session& session = p.session();
    const Camera view = to_camera(camera, session);
    FrameSettings settings;
    settings.render_scale = static_cast<float>(render_scale);
    settings.at_rest = !moving;
    settings.debug = unwrap(parse_debug_view(debug));
    const py::gil_scoped_release release;
    unwrap(session.step(view, size.first, size.second, settings, n));
}

void set_quality(Project& p, const std::string& quality, const std::string& format) {
    const Quality level = unwrap(parse_quality(quality));
    std::optional<PageFormat> page_format;
    if (!format.empty()) page_format = unwrap(parse_page_format(format));
    unwrap(p.session().set_quality(level, page_format));
}

void announce(Project& p, const py::object& camera) {
    Session& session = p.session();
    unwrap(session.announce(camera.is_none() ? std::nullopt : std::optional(to_camera(camera, session))));
}

// A dict: "gbuffer" float16 (height, width, 4), "depth" float32 (height, width) or None.
py::dict ground_buffers(Project& p, const py::object& camera, std::pair<int, int> size) {
    Session& session = p.session();
    const Camera view = to_camera(camera, session);
    if (size.first < 1 || size.second < 1 || size.first > 16384 || size.second > 16384)
        throw PythonError(
            fmt::format("size {}x{} is outside 1 … 16384 pixels a side", size.first, size.second));
    GroundBuffers buffers;
    {
        const py::gil_scoped_release release;
        buffers = unwrap(session.ground_buffers(view, size.first, size.second));
    }
    py::dict out;
    out["gbuffer"] =
        py::array(py::dtype("float16"), {buffers.height, buffers.width, 4}, buffers.gbuffer.data());
    out["depth"] = py::none();
    if (!buffers.depth.empty())
        out["depth"] = py::array_t<float>({buffers.height, buffers.width}, buffers.depth.data());
    return out;
}

py::object stats(Project& p) {
    Session& session = p.session();
    Json json;
    json["document"] = to_report(session.document().statistics());
    json["settings"] = to_report(session.document().settings());
    json["frames"] = session.frames_rendered();
    if (session.device()) {
        Renderer* renderer = unwrap(session.renderer());
        json["device"] = session.device()->caps().name;
        json["frame"] = to_report(renderer->statistics());
        json["pending_pages"] = renderer->pending_pages();
        json["settled"] = renderer->settled();
        json["allocated_bytes"] = memory_report(session);
    }
    return to_python(json);
}

py::object history(Project& p, int newest) {
    Json out = Json::array();
    for (const auto& entry : unwrap(p.session().document().history(newest)))
        out.push_back({{"sequence", entry.sequence},
                       {"group", entry.group},
                       {"applied", entry.applied},
                       {"command", Json::parse(entry.json)}});
    return to_python(out);
}

py::object operators(Project& p) {
    Json out = Json::array();
    for (const Operator& op : p.session().document().operators()) {
        Json row = Json::parse(operator_json(op));
        row["id"] = op.id;
        out.push_back(std::move(row));
    }
    return to_python(out);
}

// A command of keyword arguments.
py::object apply_keywords(Project& p, const char* name, const py::kwargs& keywords) {
    py::dict command(keywords);
    command["cmd"] = name;
    return p.apply(command);
}

// What a game calls for its actors.
struct Events {
    Project& project;
    [[nodiscard]] Prints& prints() const { return project.session().prints(); }
};

void bind_events(py::module_& module) {
    using Place = std::array<double, 2>;
    py::class_<Events> c(module, "Events");
    c.def(
        "step",
        [](const Events& e, uint64_t actor, int foot, const Place& at, double heading_rad, double length_m,
           double weight_kg) {
            return unwrap(e.prints().step(actor, foot, {at[0], at[1]}, heading_rad, {length_m, weight_kg}));
        },
        "A foot comes down, 0 left or 1 right; False where the ground is too hard for a print.",
        py::arg("actor"), py::arg("foot"), py::arg("at"), py::arg("heading_rad"),
        py::arg("length_m") = FootDesc{}.length_m, py::arg("weight_kg") = FootDesc{}.weight_kg);
    c.def(
        "tread",
        [](const Events& e, uint64_t actor, const Place& at, double width_m, double gauge_m,
           double weight_kg) {
            return unwrap(e.prints().tread(actor, {at[0], at[1]}, {width_m, gauge_m, weight_kg}));
        },
        "The axle of an actor is here now: tracks from where it was at its last call; how many pieces.",
        py::arg("actor"), py::arg("at"), py::arg("width_m") = TreadDesc{}.width_m,
        py::arg("gauge_m") = TreadDesc{}.gauge_m, py::arg("weight_kg") = TreadDesc{}.weight_kg);
    c.def(
        "lift", [](const Events& e, uint64_t actor) { e.prints().lift(actor); },
        "The actor's next tread begins where it is then.", py::arg("actor"));
    c.def(
        "flush", [](const Events& e) { return to_python(to_report(unwrap(e.prints().flush()))); },
        "Lays all that was gathered; pictures and moves of the time lay some by themselves.");
    c.def_property_readonly("waiting", [](const Events& e) { return e.prints().waiting(); });
    const auto number = [&](const char* name, auto member, const char* help) {
        c.def_property(
            name, [member](const Events& e) { return e.prints().settings.*member; },
            [member](const Events& e, double value) {
                using Value = std::remove_reference_t<decltype(e.prints().settings.*member)>;
                if (!(value >= 0 && value <= 1e9)) throw PythonError("must be 0 … 1000000000");
                e.prints().settings.*member = Value(value);
            },
            help);
    };
    number("lifetime_s", &PrintSettings::lifetime_s, "How long prints last; 0: for ever.");
    number("fade_s", &PrintSettings::fade_s, "Of that the last, in which they fill.");
    number("a_frame", &PrintSettings::a_frame,
           "Prints laid with a picture or a move of the time; the rest waits. 0: all.");
    number("keep", &PrintSettings::keep,
           "Prints with a lifetime on the map; the oldest are dropped. 0: any number.");
}

py::object edit_operator(Project& p, uint64_t id, const py::kwargs& changes) {
    const auto op = p.session().document().find_operator(id);
    if (!op) throw PythonError(fmt::format("there is no operator {}", id));
    py::dict command(to_python(Json::parse(operator_json(*op))));
    for (const char* key : {"order", "enabled"}) command.attr("pop")(key);
    command.attr("update")(changes);
    command["cmd"] = "edit";
    command["id"] = id;
    return p.apply(command);
}

// Control points of a smooth curve through places, with the ground's height where a place has none.
std::vector<std::vector<double>> spline_through(Project& p, const std::vector<std::vector<double>>& places,
                                                double width_m) {
    std::vector<SplinePoint> through;
    for (const std::vector<double>& at : places) {
        if (at.size() < 2 || at.size() > 5)
            throw PythonError("a place is (x, y), (x, y, z), (x, y, z, width) or (x, y, z, width, roll)");
        through.push_back({at[0], at[1], at.size() > 2 ? at[2] : unwrap(p.session().height_m(at[0], at[1])),
                           at.size() > 3 ? at[3] : width_m, at.size() > 4 ? at[4] : 0});
    }
    std::vector<std::vector<double>> points;
    for (const SplinePoint& point : bezier_through(through))
        points.push_back({point.x_m, point.y_m, point.z_m, point.width_m, point.roll_rad});
    return points;
}

uint32_t count_stale_pages(Project& p) {
    Session& session = p.session();
    Renderer* renderer = unwrap(session.renderer());
    const py::gil_scoped_release release;
    return unwrap(renderer->count_stale_pages(*session.ring()));
}

void set(Project& p, const std::string& name, const py::object& value) {
    std::string text;
    if (py::isinstance<py::bool_>(value))
        text = value.cast<bool>() ? "true" : "false";
    else
        text = py::str(value);
    ProjectSettings settings = p.session().document().settings();
    unwrap(set_by_name(settings, name, text));
    unwrap(p.session().change_settings(settings));
}

py::object add_layer(Project& p, const std::string& folder, const std::optional<std::string>& name,
                     double tile_m, const std::optional<std::string>& normal,
                     const std::optional<std::string>& color, int size, double relief) {
    AddLayerRequest request{
        .pack = {.folder = folder, .size_texels = size, .normal = {}, .color = {}, .relief = relief},
        .name = name.value_or(""),
        .tile_m = tile_m};
    if (normal) request.pack.normal = unwrap(parse_normal_direction(*normal));
    if (color) request.pack.color = unwrap(parse_color_encoding(*color));
    Session& session = p.session();
    AddedLayer added;
    {
        const py::gil_scoped_release release;
        added = unwrap(session.add_layer(request, keep_going));
    }
    return to_python(Json{{"name", added.entry.name},
                          {"index", added.index},
                          {"file", added.entry.file},
                          {"tile_m", added.entry.tile_m},
                          {"report", added.report}});
}

void bind_edits(py::class_<Project>& c) {
    using Points = std::vector<std::array<double, 2>>;
    c.def("apply", &Project::apply, "Applies a command (a dict or JSON); returns the rectangles it touched.",
          py::arg("command"));
    c.def(
        "sculpt",
        [](Project& p, const std::string& mode, const Points& dabs, double radius_m, double strength,
           double hardness, double target_m, uint64_t group) {
            Json j = {{"cmd", "sculpt"},
                      {"mode", mode},
                      {"dabs", dabs},
                      {"radius_m", radius_m},
                      {"hardness", hardness}};
            j[mode == "raise" || mode == "lower" ? "strength_m" : "strength"] = strength;
            if (mode == "flatten") j["target_m"] = target_m;
            if (group) j["group"] = group;
            return p.apply_json(j);
        },
        "raise, lower (strength in metres a dab), smooth or flatten (strength 0 … 1).", py::arg("mode"),
        py::arg("dabs"), py::arg("radius_m") = 10.0, py::arg("strength") = 0.5, py::arg("hardness") = 0.5,
        py::arg("target_m") = 0.0, py::arg("group") = 0);
    c.def(
        "paint",
        [](Project& p, const Points& dabs, const py::object& layer_name, double radius_m, double strength,
           double hardness, const py::object& tint, uint32_t seed, uint64_t group) {
            Json j = {{"cmd", "paint"},       {"dabs", dabs},         {"radius_m", radius_m},
                      {"strength", strength}, {"hardness", hardness}, {"seed", seed}};
            if (!layer_name.is_none()) j["layer"] = layer_name.cast<std::string>();
            if (!tint.is_none()) j["tint"] = tint.cast<std::array<double, 3>>();
            if (group) j["group"] = group;
            return p.apply_json(j);
        },
        "Paints a layer, a tint (sRGB 0 … 1), or both.", py::arg("dabs"), py::arg("layer") = py::none(),
        py::arg("radius_m") = 5.0, py::arg("strength") = 1.0, py::arg("hardness") = 0.5,
        py::arg("tint") = py::none(), py::arg("seed") = 0, py::arg("group") = 0);
    c.def(
        "fill", [](Project& p, const py::kwargs& keywords) { return apply_keywords(p, "fill", keywords); },
        "Paints all of a rectangle, or of the map, or only the texels of one layer: rect=(x0, y0, x1, y1), "
        "layer, tint, "
        "replace, strength, min_slope_rad, max_slope_rad, min_height_m, max_height_m, noise, noise_size_m, "
        "seed, "
        "transitions. One step to undo.");
    c.def(
        "crater",
        [](Project& p, double x, double y, double radius_m, double depth_m, uint32_t seed, double heat) {
            Json j = {{"cmd", "crater"}, {"x", x}, {"y", y}, {"radius_m", radius_m}, {"seed", seed}};
            if (depth_m > 0) j["depth_m"] = depth_m;
            if (heat != 0) j["heat"] = heat;
            return p.apply_json(j);
        },
        "A crater; depth 0: two fifths of the radius; heat 0 … 1: embers, on maps with thermal or emissive.",
        py::arg("x"), py::arg("y"), py::arg("radius_m") = 10.0, py::arg("depth_m") = 0.0, py::arg("seed") = 0,
        py::arg("heat") = 0.0);
    c.def(
        "footprints",
        [](Project& p, const std::vector<std::array<double, 3>>& prints, double length_m, double depth_m,
           uint32_t seed) {
            Json list = Json::array();
            for (size_t i = 0; i < prints.size(); ++i)
                list.push_back({{"x", prints[i][0]},
                                {"y", prints[i][1]},
                                {"heading_rad", prints[i][2]},
                                {"foot", i % 2}});
            return p.apply_json({{"cmd", "footprints"},
                                 {"prints", list},
                                 {"length_m", length_m},
                                 {"depth_m", depth_m},
                                 {"seed", seed}});
        },
        "Footprints at (x, y, heading_rad), left and right in turn.", py::arg("prints"),
        py::arg("length_m") = 0.3, py::arg("depth_m") = 0.03, py::arg("seed") = 0);
    c.def(
        "decal",
        [](Project& p, double x, double y, const py::kwargs& keywords) {
            keywords["x"] = x;
            keywords["y"] = y;
            return apply_keywords(p, "decal", keywords);
        },
        "A terrain decal at (x, y): half_m, heading_rad, outline, layer, colour, opacity, edge and so on.",
        py::arg("x"), py::arg("y"));
    c.def(
        "spline",
        [](Project& p, const py::object& points, const py::kwargs& keywords) {
            keywords["points"] = points;
            return apply_keywords(p, "spline", keywords);
        },
        "A splined decal of Bezier control points (x, y, z, width): carve, shoulder_m, fade_m, layer and so "
        "on.",
        py::arg("points"));
    c.def("spline_through", &spline_through,
          "Control points of a smooth curve through (x, y), (x, y, z) or (x, y, z, width); without a z: the "
          "ground's.",
          py::arg("places"), py::arg("width_m") = 4.0);
    c.def(
        "volume",
        [](Project& p, const std::array<double, 3>& at, const py::kwargs& keywords) {
            keywords["at"] = at;
            return apply_keywords(p, "volume", keywords);
        },
        "A volume decal at (x, y, z): half_m, direction, roll_rad, outline, layer and so on.", py::arg("at"));
    c.def(
        "stamp",
        [](Project& p, const std::string& image, double x, double y, const py::kwargs& keywords) {
            keywords["image"] = image;
            keywords["x"] = x;
            keywords["y"] = y;
            return apply_keywords(p, "stamp", keywords);
        },
        "A stamp of the project at (x, y): half_m, heading_rad, mode (add, max, min, blend), height_m, "
        "base_m, "
        "strength, edge, layer, layer_from, colour.",
        py::arg("image"), py::arg("x"), py::arg("y"));
    c.def(
        "cutout",
        [](Project& p, const std::string& form, const py::kwargs& keywords) {
            keywords["form"] = form;
            return apply_keywords(p, "cutout", keywords);
        },
        "A hole: form box or cylinder (at, half_m, direction, roll_rad), convex (corners) or brush (dabs, "
        "radius_m); fill=True closes what those before it opened.",
        py::arg("form"));
    c.def(
        "add_stamp",
        [](Project& p, const std::string& file, const std::string& name) {
            const AddedStamp added = unwrap(add_stamp(p.session().document().folder(), file, name));
            return to_python(Json{{"name", added.name},
                                  {"width", added.width},
                                  {"height", added.height},
                                  {"colours", added.has_colors},
                                  {"cover", added.has_cover},
                                  {"black", added.black},
                                  {"white", added.white},
                                  {"notes", added.notes}});
        },
        "Makes a stamp of a picture's brightness; returns what it has.", py::arg("file"),
        py::arg("name") = "");
    c.def(
        "stamps", [](Project& p) { return p.session().document().stamps(); },
        "Names of the project's stamps.");
    c.def(
        "functions",
        [](Project& p) { return to_python(function_report(p.session().document().functions())); },
        "The functions that decals can be made by: name, says, steps, parameters (value, min, max, says), "
        "and where "
        "something is wrong error and failed_texels.");
    c.def(
        "function_text",
        [](Project& p, const std::string& name) {
            return unwrap(p.session().document().functions().text(name));
        },
        "The text of a function.", py::arg("name"));
    c.def(
        "set_function",
        [](Project& p, const std::string& name, const std::string& text) {
            return p.apply_json({{"cmd", "function"}, {"name", name}, {"text", text}});
        },
        "Saves and shows the text of a function once it compiles.", py::arg("name"), py::arg("text"));
    c.def(
        "poll_functions", [](Project& p) { return to_python(to_report(p.session().poll_functions())); },
        "Shows texts of functions that another program has saved meanwhile.");
    c.def("edit_operator", &edit_operator, "Changes parameters of an operator; the rest stay.",
          py::arg("id"));
    c.def(
        "reorder_operator",
        [](Project& p, uint64_t id, uint64_t order) {
            return p.apply_json({{"cmd", "reorder"}, {"id", id}, {"order", order}});
        },
        "Operators of a kind are drawn in ascending order, then id.", py::arg("id"), py::arg("order"));
    c.def(
        "show_operator",
        [](Project& p, uint64_t id, bool shown) {
            return p.apply_json({{"cmd", "operator"}, {"id", id}, {"enabled", shown}});
        },
        "Switches an operator on or off.", py::arg("id"), py::arg("shown") = true);
    c.def(
        "remove_operator",
        [](Project& p, uint64_t id) {
            return p.apply_json({{"cmd", "remove"}, {"id", id}});
        },
        py::arg("id"));
    c.def(
        "undo",
        [](Project& p) {
            return p.apply_json({{"cmd", "undo"}});
        },
        "Undoes the newest group of commands.");
    c.def_property(
        "time_s", [](Project& p) { return p.session().document().time_s(); },
        [](Project& p, double time_s) {
            p.apply_json({{"cmd", "time"}, {"time_s", time_s}});
        },
        "Operators with a life and events are shown as they are at this time, seconds.");
    c.def(
        "event",
        [](Project& p, const std::string& kind, const py::kwargs& keywords) {
            keywords["event"] = kind;
            return apply_keywords(p, "event", keywords);
        },
        "An event: crater (x, y, energy_j), crater_line (x, y, to, count), barrage (x, y, radius_m, count), "
        "crash (x, y, to, width_m, count), landslide (x, y, to, radius_m, volume_m3) or flood (x, y, "
        "radius_m, "
        "level_m, from_m, layer); of all start_s, duration_s, seed; of impacts cool_s, weather_s.",
        py::arg("kind"));
    c.def(
        "event_cost",
        [](Project& p, uint64_t id) {
            const auto cost = p.session().document().event_cost(id);
            py::dict d;
            d["stored_bytes"] = cost.stored_bytes;
            d["parts"] = cost.parts;
            d["memory_bytes"] = cost.memory_bytes;
            return d;
        },
        "Bytes of an event's parameters, how many operators they stand for, and what those take in memory.",
        py::arg("id"));
    c.def_property_readonly(
        "events", [](Project& p) { return Events{p}; }, py::keep_alive<0, 1>(),
        "The calls that a game makes: step, tread, lift, flush.");
    c.def("redo", [](Project& p) { return p.apply_json({{"cmd", "redo"}}); });
    c.def_property_readonly("can_undo", [](Project& p) { return p.session().document().can_undo(); });
    c.def_property_readonly("can_redo", [](Project& p) { return p.session().document().can_redo(); });
    c.def("set", &set, "Changes a setting, as `loam set` names them.", py::arg("name"), py::arg("value"));
    c.def(
        "transition",
        [](Project& p, const std::string& name, const std::string& from, const std::string& to,
           std::optional<double> threshold) {
            unwrap(p.session().apply({TransitionCommand{name, from, to, threshold, false}}));
        },
        "Makes or changes a transition between two layers.", py::arg("name"), py::arg("from_layer") = "",
        py::arg("to_layer") = "", py::arg("threshold") = py::none());
    c.def(
        "remove_transition",
        [](Project& p, const std::string& name) {
            unwrap(p.session().apply({TransitionCommand{name, {}, {}, {}, true}}));
        },
        "Its texels show the nearer of its layers from now on.", py::arg("name"));
    c.def(
        "add_imagery",
        [](Project& p, const std::string& file, std::optional<double> strength,
           std::optional<double> distance_m) {
            AddedImagery added;
            {
                const py::gil_scoped_release release;
                added = unwrap(p.session().add_imagery({file, strength, distance_m}, keep_going));
            }
            return to_python(Json{{"file", added.settings.file},
                                  {"texel_m", added.shape.spacing_m},
                                  {"width", added.width},
                                  {"height", added.height},
                                  {"bytes", added.size_bytes},
                                  {"notes", added.notes}});
        },
        "Lays a picture over the whole map as its far look; returns what was made of it.", py::arg("file"),
        py::arg("strength") = py::none(), py::arg("distance_m") = py::none());
    c.def(
        "import_weights",
        [](Project& p, const std::string& folder, bool tint, bool transitions) {
            WeightsReport report;
            {
                const py::gil_scoped_release release;
                report = unwrap(p.session().import_weights({folder, tint, transitions}, keep_going));
            }
            return to_python(to_report(report));
        },
        "Makes the index map of pictures of weights named after layers; returns what was lost.",
        py::arg("folder"), py::arg("tint") = true, py::arg("transitions") = true);
    c.def("add_layer", &add_layer,
          "Makes a layer of a folder of maps; returns its name, index, file and the packer's report.",
          py::arg("folder"), py::arg("name") = py::none(), py::arg("tile_m") = 2.0,
          py::arg("normal") = py::none(), py::arg("color") = py::none(), py::arg("size") = 0,
          py::arg("relief") = 0.03);
    c.def(
        "record_to", [](Project& p, const std::string& file) { unwrap(p.session().record_to(file)); },
        "Appends every command from now on to a script.", py::arg("file"));
}

void bind_queries(py::class_<Project>& c) {
    c.def("height", &height, "Height of the composed ground in metres at points (numbers or arrays).",
          py::arg("x"), py::arg("y"));
    c.def("normal", &normal, "Unit normals, shape (…, 3).", py::arg("x"), py::arg("y"));
    c.def("layer", &layer, "Layer numbers.", py::arg("x"), py::arg("y"));
    c.def("is_cut", &is_cut, "Whether there is a hole in the ground.", py::arg("x"), py::arg("y"));
    c.def("ray_cast", &ray_cast,
          "First hit (x, y, z) of a ray with the ground, or None. It goes through holes.", py::arg("origin"),
          py::arg("direction"), py::arg("max_m") = 50'000.0);
    c.def("stats", &stats, "Figures of document, frame and memory.");
    c.def("history", &history, "The newest commands.", py::arg("newest") = 100);
    c.def("operators", &operators, "Craters, footprints and so on, in order.");
    c.def(
        "digest", [](Project& p) { return unwrap(p.session().document().content_digest()); },
        "A number of all base pages and operators: equal digests, equal documents.");
    c.def("count_stale_pages", &count_stale_pages,
          "Resident pages that differ from their composition from nothing: always 0.");
    c.def("validation_messages", [](Project& p) {
        return p.session().device() ? p.session().device()->validation_message_count() : 0u;
    });
    c.def_property_readonly("bounds", [](Project& p) {
        const WorldRect b = p.session().document().bounds();
        return py::make_tuple(b.min_x, b.min_y, b.max_x, b.max_y);
    });
    c.def_property_readonly("layers", [](Project& p) {
        std::vector<std::string> names;
        for (const LayerEntry& l : p.session().document().settings().layers) names.push_back(l.name);
        return names;
    });
}

}  // namespace

Project::Project(const std::string& path, const std::string& device, bool read_only, bool validation,
                 const std::string& quality, const std::string& format, const py::dict& settings) {
    SessionDesc desc;
    desc.device.device_filter = device;
    desc.device.validation = validation;
    desc.mode = read_only ? OpenMode::read_only : OpenMode::read_write;
    if (!quality.empty()) desc.renderer.quality = unwrap(parse_quality(quality));
    if (!format.empty()) desc.renderer.page_format = unwrap(parse_page_format(format));
    for (const auto& [name, value] : settings)
        unwrap(change_setting(desc.renderer, py::str(name).cast<std::string>(),
                              py::str(value).cast<std::string>()));
    session_ = unwrap(Session::open(path, desc));
}

Session& Project::session() {
    if (!session_) throw PythonError("the project is closed");
    return *session_;
}

py::object Project::apply(const py::handle& command) {
    return to_python(to_report(unwrap(session().apply(unwrap(parse_command(command_line(command)))))));
}

py::object Project::apply_json(const Json& command) {
    return to_python(to_report(unwrap(session().apply(unwrap(parse_command(command.dump()))))));
}

void bind_project(py::module_& module) {
    py::class_<Camera>(module, "Camera")
        .def_static(
            "look_at",
            [](std::array<double, 3> eye, std::array<double, 3> target, double fov_deg) {
                return Camera::look_at({eye[0], eye[1], eye[2]}, {target[0], target[1], target[2]},
                                       fov_deg * 0.017453292519943295);
            },
            py::arg("eye"), py::arg("target"), py::arg("fov_deg") = 57.0)
        .def_property_readonly(
            "position",
            [](const Camera& c) { return py::make_tuple(c.position_m.x, c.position_m.y, c.position_m.z); })
        .def_readonly("yaw_rad", &Camera::yaw_rad)
        .def_readonly("pitch_rad", &Camera::pitch_rad);
    bind_events(module);
    py::class_<Project> c(module, "Project");
    bind_edits(c);
    bind_queries(c);
    c.def("default_camera", [](Project& p) { return p.session().default_camera(); });
    c.def("step", &step, "Renders n frames without waiting for the picture to settle.",
          py::arg("camera") = py::none(), py::arg("n") = 1, py::arg("size") = std::pair(960, 540),
          py::arg("render_scale") = 1.0, py::arg("moving") = false, py::arg("debug") = "none");
    c.def("set_quality", &set_quality,
          "very_low, low, mid, high or ultra, and bc1 or rgba8 (default by device), from the next frames on: "
          "the "
          "picture keeps its texels until the new texture has them.",
          py::arg("quality"), py::arg("format") = "");
    c.def("announce", &announce,
          "The camera will soon be there: its pages are made in the frames until then. None: no longer.",
          py::arg("camera"));
    c.def("render", &render, "Renders until the picture rests; uint8 (height, width, 4), sRGB-encoded.",
          py::arg("camera") = py::none(), py::arg("size") = std::pair(960, 540), py::arg("reference") = false,
          py::arg("supersample") = 1, py::arg("debug") = "none", py::arg("render_scale") = 1.0,
          py::arg("max_frames") = 600, py::arg("filter") = "auto");
    c.def("ground_buffers", &ground_buffers,
          "What the ground pass of one more frame wrote: normal x, y and log2 footprints; depth.",
          py::arg("camera") = py::none(), py::arg("size") = std::pair(960, 540));
    c.def("close", &Project::close, "Closes the project; what was applied is on disk already.");
    c.def_property_readonly("closed", &Project::closed);
    c.def(
        "__enter__", [](Project& p) -> Project& { return p; }, py::return_value_policy::reference);
    c.def("__exit__", [](Project& p, const py::args&) { p.close(); });
}

}  // namespace loam::python
