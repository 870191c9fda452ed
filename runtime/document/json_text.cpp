// Commands and operators as JSON, both ways. Exceptions of nlohmann-json, and json_fields.h's `Refused`, end
// at the two parse functions.
#include <cmath>

#include "runtime/document/command.h"
#include "runtime/document/decal_json.h"
#include "runtime/document/operator_json.h"

namespace loam {

namespace {

constexpr std::pair<const char*, SculptMode> kModes[] = {{"raise", SculptMode::raise},
                                                         {"lower", SculptMode::lower},
                                                         {"smooth", SculptMode::smooth},
                                                         {"flatten", SculptMode::flatten}};

SculptCommand read_sculpt(Fields& fields) {
    SculptCommand c;
    const std::string mode = fields.text("mode");
    bool found = false;
    for (const auto& [name, value] : kModes)
        if (mode == name) c.mode = value, found = true;
    if (!found) refuse("sculpt: unknown mode \"{}\" (known: raise, lower, smooth, flatten)", mode);
    c.dabs = read_dabs(fields);
    c.radius_m = fields.number("radius_m", c.radius_m);
    if (fields.find("strength") && fields.find("strength_m"))
        refuse("sculpt: give \"strength\" or \"strength_m\", not both");
    c.strength = fields.number("strength_m", fields.number("strength", c.strength));
    c.hardness = fields.number("hardness", c.hardness);
    c.target_m = c.mode == SculptMode::flatten ? fields.number("target_m") : fields.number("target_m", 0);
    return c;
}

// What paint and fill share.
template <typename PaintingCommand>
void read_painting(std::string_view command, Fields& fields, PaintingCommand& c) {
    if (const Json* layer = fields.find("layer")) c.layer = fields.text_of(*layer, "layer");
    if (const Json* tint = fields.find("tint")) {
        if (!tint->is_array() || tint->size() != 3)
            refuse("{}: \"tint\" must be [red, green, blue]", command);
        c.tint = glm::dvec3(fields.number_of((*tint)[0], "tint"), fields.number_of((*tint)[1], "tint"),
                            fields.number_of((*tint)[2], "tint"));
    }
    c.strength = fields.number("strength", c.strength);
    GroundMask& m = c.mask;
    m.min_slope_rad = fields.number("min_slope_rad", m.min_slope_rad);
    m.max_slope_rad = fields.number("max_slope_rad", m.max_slope_rad);
    m.min_height_m = fields.number("min_height_m", m.min_height_m);
    m.max_height_m = fields.number("max_height_m", m.max_height_m);
    m.noise = fields.number("noise", m.noise);
    m.noise_size_m = fields.number("noise_size_m", m.noise_size_m);
    c.seed = uint32_t(fields.whole("seed", kMaxU32, 0));
    c.transitions = fields.truth("transitions", c.transitions);
}

PaintCommand read_paint(Fields& fields) {
    PaintCommand c;
    c.dabs = read_dabs(fields);
    c.radius_m = fields.number("radius_m", c.radius_m);
    c.hardness = fields.number("hardness", c.hardness);
    read_painting("paint", fields, c);
    return c;
}

FillCommand read_fill(Fields& fields) {
    FillCommand c;
    if (const Json* rect = fields.find("rect")) {
        if (!rect->is_array() || rect->size() != 4) refuse("fill: \"rect\" must be [x0, y0, x1, y1]");
        const auto at = [&](size_t i) { return fields.number_of((*rect)[i], "rect"); };
        c.rect = WorldRect{at(0), at(1), at(2), at(3)};
    }
    if (const Json* replace = fields.find("replace")) c.replace = fields.text_of(*replace, "replace");
    read_painting("fill", fields, c);
    return c;
}

Crater read_crater(Fields& fields) {
    Crater crater;
    crater.x_m = fields.number("x");
    crater.y_m = fields.number("y");
    crater.radius_m = fields.number("radius_m", crater.radius_m);
    crater.depth_m = fields.number("depth_m", crater.depth_m);
    crater.seed = uint32_t(fields.whole("seed", kMaxU32, 0));
    crater.heat = fields.number("heat", crater.heat);
    crater.age = fields.number("age", crater.age);
    return crater;
}

void write_crater(Json& json, const Crater& crater) {
    json["x"] = crater.x_m;
    json["y"] = crater.y_m;
    json["radius_m"] = crater.radius_m;
    json["depth_m"] = crater.depth_m;
    json["seed"] = crater.seed;
    if (crater.heat != 0) json["heat"] = crater.heat;  // a cold crater reads as it always has
    if (crater.age != 0) json["age"] = crater.age;     // and a fresh one
}

// What a print does not say itself comes from `shared`.
Footprint read_print(Fields& fields, const Footprint& shared) {
    Footprint print;
    print.x_m = fields.number("x");
    print.y_m = fields.number("y");
    print.heading_rad = fields.number("heading_rad", 0);
    print.foot = int(fields.whole("foot", kFurrow, 0));
    print.length_m = fields.number("length_m", shared.length_m);
    print.depth_m = fields.number("depth_m", shared.depth_m);
    print.seed = uint32_t(fields.whole("seed", kMaxU32, shared.seed));
    return print;
}

void write_print(Json& json, const Footprint& print) {
    json["x"] = print.x_m;
    json["y"] = print.y_m;
    json["heading_rad"] = print.heading_rad;
    json["foot"] = print.foot;
}

FootprintsCommand read_footprints(Fields& fields) {
    FootprintsCommand c;
    Footprint shared;
    shared.length_m = fields.number("length_m", shared.length_m);
    shared.depth_m = fields.number("depth_m", shared.depth_m);
    shared.seed = uint32_t(fields.whole("seed", kMaxU32, 0));
    for (const Json& json : fields.list("prints")) {
        Fields print(json, fmt::format("footprints: print {}", c.prints.size()));
        c.prints.push_back(read_print(print, shared));
        print.finish();
        ++shared.seed;
    }
    c.life = read_life(fields);
    c.keep = fields.whole("keep", kMaxId, 0);
    return c;
}

void write(Json& json, const SculptCommand& c) {
    json["cmd"] = "sculpt";
    for (const auto& [name, value] : kModes)
        if (c.mode == value) json["mode"] = name;
    json["dabs"] = dabs_json(c.dabs);
    json["radius_m"] = c.radius_m;
    json[c.mode == SculptMode::raise || c.mode == SculptMode::lower ? "strength_m" : "strength"] = c.strength;
    json["hardness"] = c.hardness;
    if (c.mode == SculptMode::flatten) json["target_m"] = c.target_m;
}

template <typename PaintingCommand>
void write_painting(Json& json, const PaintingCommand& c) {
    if (c.layer) json["layer"] = *c.layer;
    if (c.tint) json["tint"] = {c.tint->x, c.tint->y, c.tint->z};
    json["strength"] = c.strength;
    const GroundMask& m = c.mask;
    json["min_slope_rad"] = m.min_slope_rad;
    json["max_slope_rad"] = m.max_slope_rad;
    const GroundMask any;
    if (m.min_height_m != any.min_height_m) json["min_height_m"] = m.min_height_m;
    if (m.max_height_m != any.max_height_m) json["max_height_m"] = m.max_height_m;
    if (m.noise != any.noise) json["noise"] = m.noise;
    if (m.noise_size_m != any.noise_size_m) json["noise_size_m"] = m.noise_size_m;
    json["seed"] = c.seed;
    if (c.transitions) json["transitions"] = true;
}

void write(Json& json, const PaintCommand& c) {
    json["cmd"] = "paint";
    json["dabs"] = dabs_json(c.dabs);
    json["radius_m"] = c.radius_m;
    json["hardness"] = c.hardness;
    write_painting(json, c);
}

void write(Json& json, const FillCommand& c) {
    json["cmd"] = "fill";
    if (c.rect) json["rect"] = {c.rect->min_x, c.rect->min_y, c.rect->max_x, c.rect->max_y};
    if (c.replace) json["replace"] = *c.replace;
    write_painting(json, c);
}

void write(Json& json, const CraterCommand& c) {
    json["cmd"] = "crater";
    write_crater(json, c.crater);
    write_life(json, c.life);
}

void write(Json& json, const FootprintsCommand& c) {
    json["cmd"] = "footprints";
    Footprint shared = c.prints.empty() ? Footprint() : c.prints[0];
    json["length_m"] = shared.length_m;
    json["depth_m"] = shared.depth_m;
    json["seed"] = shared.seed;
    json["prints"] = Json::array();
    for (const Footprint& print : c.prints) {
        Json& one = json["prints"].emplace_back(Json::object());
        write_print(one, print);
        if (print.length_m != shared.length_m) one["length_m"] = print.length_m;
        if (print.depth_m != shared.depth_m) one["depth_m"] = print.depth_m;
        if (print.seed != shared.seed) one["seed"] = print.seed;
        ++shared.seed;
    }
    write_life(json, c.life);
    if (c.keep != 0) json["keep"] = c.keep;
}

void write(Json& json, const SetOperatorCommand& c) {
    json["cmd"] = "operator";
    json["id"] = c.id;
    json["enabled"] = c.enabled;
}
void write(Json& json, const RemoveOperatorCommand& c) {
    json["cmd"] = "remove";
    json["id"] = c.id;
}
void write(Json& json, const TransitionCommand& c) {
    json["cmd"] = "transition";
    json["name"] = c.name;
    if (!c.from.empty()) json["from"] = c.from;
    if (!c.to.empty()) json["to"] = c.to;
    if (c.threshold) json["threshold"] = *c.threshold;
    if (c.remove) json["remove"] = true;
}
TransitionCommand read_transition(Fields& fields) {
    TransitionCommand c;
    c.name = fields.text("name");
    if (fields.find("from")) c.from = fields.text("from");
    if (fields.find("to")) c.to = fields.text("to");
    if (fields.find("threshold")) c.threshold = fields.number("threshold");
    c.remove = fields.truth("remove", false);
    return c;
}
void write(Json& json, const TimeCommand& c) {
    json["cmd"] = "time";
    json["time_s"] = c.time_s;
}
void write(Json& json, const FunctionCommand& c) {
    json["cmd"] = "function";
    json["name"] = c.name;
    json["text"] = c.text;
}
void write(Json& json, const UndoCommand&) {
    json["cmd"] = "undo";
}
void write(Json& json, const RedoCommand&) {
    json["cmd"] = "redo";
}

OperatorShape read_shape(const std::string& kind, Fields& fields) {
    if (kind == "crater") return read_crater(fields);
    if (kind == "footprint") return read_print(fields, {});
    if (kind == "decal") return read_decal(fields);
    if (kind == "spline") return read_spline(fields);
    if (kind == "volume") return read_volume(fields);
    if (kind == "stamp") return read_stamp(fields);
    if (kind == "cutout") return read_cutout(fields);
    if (kind == "slide") return read_slide(fields);
    if (kind == "flood") return read_flood(fields);
    if (kind == "event") return read_event(fields);
    refuse(
        "{}: unknown kind \"{}\" (known: crater, footprint, decal, spline, volume, stamp, cutout, slide, "
        "flood, "
        "event)",
        fields.place(), kind);
}

// Its kind's name; its parameters go into `json`.
struct ShapeWriter {
    Json& json;
    const char* operator()(const Crater& crater) const {
        write_crater(json, crater);
        return "crater";
    }
    const char* operator()(const Footprint& print) const {
        write_print(json, print);
        json["length_m"] = print.length_m;
        json["depth_m"] = print.depth_m;
        json["seed"] = print.seed;
        return "footprint";
    }
    const char* operator()(const TerrainDecal& decal) const {
        write_decal(json, decal);
        return "decal";
    }
    const char* operator()(const SplineDecal& spline) const {
        write_spline(json, spline);
        return "spline";
    }
    const char* operator()(const VolumeDecal& volume) const {
        write_volume(json, volume);
        return "volume";
    }
    const char* operator()(const Stamp& stamp) const {
        write_stamp(json, stamp);
        return "stamp";
    }
    const char* operator()(const Cutout& cutout) const {
        write_cutout(json, cutout);
        return "cutout";
    }
    const char* operator()(const Slide& slide) const {
        write_slide(json, slide);
        return "slide";
    }
    const char* operator()(const Flood& flood) const {
        write_flood(json, flood);
        return "flood";
    }
    const char* operator()(const Event& event) const {
        write_event(json, event);
        return "event";
    }
};

void write(Json& json, const AddOperatorCommand& c) {
    json["cmd"] = std::visit(ShapeWriter{json}, c.shape);
    write_life(json, c.life);
}
void write(Json& json, const EditOperatorCommand& c) {
    json["kind"] = std::visit(ShapeWriter{json}, c.shape);
    json["cmd"] = "edit";
    json["id"] = c.id;
    if (!c.life) return;
    write_life(json, *c.life);
    if (c.life->ever()) json["life"] = Json::object();
}
void write(Json& json, const ReorderCommand& c) {
    json["cmd"] = "reorder";
    json["id"] = c.id;
    json["order"] = c.order;
}

CommandBody read_body(const std::string& name, Fields& fields) {
    if (name == "sculpt") return read_sculpt(fields);
    if (name == "paint") return read_paint(fields);
    if (name == "fill") return read_fill(fields);
    if (name == "crater") {
        const Crater crater = read_crater(fields);
        return CraterCommand{crater, read_life(fields)};
    }
    if (name == "footprints") return read_footprints(fields);
    if (name == "event") return AddOperatorCommand{read_event(fields)};  // its parts have lives
    for (const char* kind : {"decal", "spline", "volume", "stamp", "cutout", "slide", "flood"}) {
        if (name != kind) continue;
        OperatorShape shape = read_shape(name, fields);
        return AddOperatorCommand{std::move(shape), read_life(fields)};
    }
    if (name == "edit") {
        const uint64_t id = fields.whole("id", kMaxId);
        EditOperatorCommand edit{id, read_shape(fields.text("kind"), fields)};
        if (!std::holds_alternative<Event>(edit.shape) && fields.find("life")) edit.life = read_life(fields);
        return edit;
    }
    if (name == "time") return TimeCommand{fields.number("time_s")};
    if (name == "function") {
        std::string function = fields.text("name");
        return FunctionCommand{std::move(function), fields.text("text")};
    }
    if (name == "reorder") {
        const uint64_t id = fields.whole("id", kMaxId);
        return ReorderCommand{id, fields.whole("order", kMaxId)};
    }
    if (name == "operator") {
        SetOperatorCommand c;
        c.id = fields.whole("id", kMaxId);
        c.enabled = fields.truth("enabled");
        return c;
    }
    if (name == "remove") return RemoveOperatorCommand{fields.whole("id", kMaxId)};
    if (name == "transition") return read_transition(fields);
    if (name == "undo") return UndoCommand{};
    if (name == "redo") return RedoCommand{};
    refuse(
        "unknown command \"{}\" (known: sculpt, paint, fill, crater, footprints, decal, spline, volume, "
        "stamp, cutout, slide, flood, event, edit, reorder, operator, remove, transition, time, function, "
        "undo, redo)",
        name);
}

// Runs a reader over the parsed text; whatever is thrown becomes an error.
template <typename T, typename Read>
Result<T> parse(std::string_view text, Read&& read) {
    try {
        return read(Json::parse(text));
    } catch (const Refused& refused) {
        return Error{refused.message};
    } catch (const Json::parse_error& bad) {
        return error("not valid JSON, at byte {}", bad.byte);
    } catch (const std::exception& bad) {
        return error("not valid JSON: {}", bad.what());
    }
}

// Texts that are not UTF-8 (layer names from C++) must not throw.
std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Result<Command> parse_command(std::string_view json_line) {
    auto command = parse<Command>(json_line, [](const Json& json) {
        Fields start(json, "a command");
        const std::string name = start.text("cmd");
        Fields fields(json, name);
        fields.find("cmd");
        Command result;
        result.group = fields.whole("group", kMaxId, 0);
        result.body = read_body(name, fields);
        fields.finish();
        return result;
    });
    if (!command.ok()) return command;
    const Status status = check_command(*command);
    if (!status.ok()) return status.error();
    return command;
}

std::string to_json(const Command& command) {
    Json json;
    std::visit([&](const auto& body) { write(json, body); }, command.body);
    if (command.group != 0) json["group"] = command.group;
    return dump(json);
}

std::string transition_json(const LayerEntry& entry) {
    Json json;
    json["name"] = entry.name;
    json["from"] = entry.blend->from;
    json["to"] = entry.blend->to;
    json["threshold"] = entry.blend->threshold;
    if (entry.blend->removed) json["removed"] = true;
    return dump(json);
}

Result<LayerEntry> parse_transition(std::string_view text) {
    return parse<LayerEntry>(text, [](const Json& json) {
        Fields fields(json, "a transition");
        LayerEntry entry{.name = fields.text("name"), .file = {}};
        entry.blend = LayerEntry::Blend{fields.text("from"), fields.text("to"), fields.number("threshold"),
                                        fields.truth("removed", false)};
        fields.finish();
        return entry;
    });
}

std::string operator_json(const Operator& op) {
    Json json;
    json["order"] = op.order;
    json["enabled"] = op.enabled;
    json["kind"] = std::visit(ShapeWriter{json}, op.shape);
    write_life(json, op.life);
    return dump(json);
}

Result<Operator> parse_operator(uint64_t id, std::string_view text) {
    auto op = parse<Operator>(text, [&](const Json& json) {
        Fields fields(json, fmt::format("operator {}", id));
        Operator result;
        result.id = id;
        result.order = fields.whole("order", kMaxId);
        result.enabled = fields.truth("enabled");
        const std::string kind = fields.text("kind");
        result.shape = read_shape(kind, fields);
        if (!std::holds_alternative<Event>(result.shape)) result.life = read_life(fields);
        fields.finish();
        return result;
    });
    // What is no JSON at all does not say whose it is.
    if (!op.ok())
        return op.message().starts_with("operator ") ? op : error("operator {}: {}", id, op.message());
    Status status = check_shape(op->shape);
    if (status.ok()) status = check_life(op->life);
    if (!status.ok()) return error("operator {}: {}", id, status.message());
    prepare(*op);
    return op;
}

}  // namespace loam
