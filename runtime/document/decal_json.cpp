#include "runtime/document/decal_json.h"

namespace loam {

namespace {

template <typename Vector>
Vector read_vector(const Fields& fields, const Json& list, const char* key) {
    constexpr int kCount = Vector::length();
    if (!list.is_array() || list.size() != size_t(kCount))
        refuse("{}: \"{}\" must be {} numbers", fields.place(), key, kCount);
    Vector v;
    for (int i = 0; i < kCount; ++i) v[i] = fields.number_of(list[size_t(i)], key);
    return v;
}

template <typename Vector>
Vector read_vector(Fields& fields, const char* key, const Vector& otherwise) {
    const Json* list = fields.find(key);
    return list ? read_vector<Vector>(fields, *list, key) : otherwise;
}

template <typename Vector>
Json vector_json(const Vector& v) {
    Json list = Json::array();
    for (int i = 0; i < Vector::length(); ++i) list.push_back(v[i]);
    return list;
}

// Name and member of each channel.
constexpr std::pair<const char*, double DecalChannels::*> kChannels[] = {
    {"albedo", &DecalChannels::albedo},
    {"normal", &DecalChannels::normal},
    {"gloss", &DecalChannels::gloss},
    {"metalness", &DecalChannels::metalness},
    {"occlusion", &DecalChannels::occlusion}};

DecalMaterial read_material(Fields& fields) {
    DecalMaterial m;
    if (const Json* layer = fields.find("layer")) m.layer = fields.text_of(*layer, "layer");
    m.colour = read_vector(fields, "colour", m.colour);
    m.gloss = fields.number("gloss", m.gloss);
    m.metalness = fields.number("metalness", m.metalness);
    m.tile_m = fields.number("tile_m", m.tile_m);
    m.opacity = fields.number("opacity", m.opacity);
    m.edge = fields.number("edge", m.edge);
    m.rough = fields.number("rough", m.rough);
    m.seed = uint32_t(fields.whole("seed", kMaxU32, 0));
    if (const Json* channels = fields.find("channels")) {
        Fields of(*channels, fields.place() + ": channels");
        for (const auto& [name, member] : kChannels) m.channels.*member = of.number(name, 1);
        of.finish();
    }
    if (const Json* function = fields.find("function")) m.function = fields.text_of(*function, "function");
    if (const Json* parameters = fields.find("parameters")) {
        if (!parameters->is_object())
            refuse("{}: \"parameters\" must be an object of numbers by name", fields.place());
        for (const auto& [name, value] : parameters->items())
            m.parameters[name] = fields.number_of(value, "parameters." + name);
    }
    return m;
}

void write_material(Json& json, const DecalMaterial& m) {
    json["layer"] = m.layer;
    json["colour"] = vector_json(m.colour);
    json["gloss"] = m.gloss;
    json["metalness"] = m.metalness;
    json["tile_m"] = m.tile_m;
    json["opacity"] = m.opacity;
    json["edge"] = m.edge;
    json["rough"] = m.rough;
    json["seed"] = m.seed;
    for (const auto& [name, member] : kChannels) json["channels"][name] = m.channels.*member;
    if (!m.function.empty()) json["function"] = m.function;
    for (const auto& [name, value] : m.parameters) json["parameters"][name] = value;
}

DecalOutline read_outline(Fields& fields) {
    const Json* outline = fields.find("outline");
    if (!outline) return DecalOutline::rectangle;
    const std::string name = fields.text_of(*outline, "outline");
    if (name != "rectangle" && name != "ellipse")
        refuse("{}: unknown outline \"{}\" (known: rectangle, ellipse)", fields.place(), name);
    return name == "ellipse" ? DecalOutline::ellipse : DecalOutline::rectangle;
}

constexpr std::pair<const char*, StampMode> kStampModes[] = {
    {"add", StampMode::add}, {"max", StampMode::max}, {"min", StampMode::min}, {"blend", StampMode::blend}};

StampMode read_stamp_mode(Fields& fields) {
    const Json* mode = fields.find("mode");
    if (!mode) return StampMode::add;
    const std::string name = fields.text_of(*mode, "mode");
    for (const auto& [known, value] : kStampModes)
        if (name == known) return value;
    refuse("{}: unknown mode \"{}\" (known: add, max, min, blend)", fields.place(), name);
}

const char* name_of(DecalOutline outline) {
    return outline == DecalOutline::ellipse ? "ellipse" : "rectangle";
}

constexpr std::pair<const char*, CutoutForm> kCutoutForms[] = {{"box", CutoutForm::box},
                                                               {"cylinder", CutoutForm::cylinder},
                                                               {"convex", CutoutForm::convex},
                                                               {"brush", CutoutForm::brush}};

CutoutForm read_form(Fields& fields) {
    const std::string name = fields.text("form");
    for (const auto& [known, value] : kCutoutForms)
        if (name == known) return value;
    refuse("{}: unknown form \"{}\" (known: box, cylinder, convex, brush)", fields.place(), name);
}

}  // namespace

std::vector<glm::dvec2> read_dabs(Fields& fields) {
    std::vector<glm::dvec2> dabs;
    for (const Json& dab : fields.list("dabs")) {
        if (!dab.is_array() || dab.size() != 2)
            refuse("{}: dab {} must be [x, y]", fields.place(), dabs.size());
        const std::string what = fmt::format("dabs[{}]", dabs.size());
        dabs.emplace_back(fields.number_of(dab[0], what), fields.number_of(dab[1], what));
    }
    return dabs;
}

Json dabs_json(const std::vector<glm::dvec2>& dabs) {
    Json list = Json::array();
    for (const glm::dvec2& dab : dabs) list.push_back({dab.x, dab.y});
    return list;
}

TerrainDecal read_decal(Fields& fields) {
    TerrainDecal d;
    d.x_m = fields.number("x");
    d.y_m = fields.number("y");
    d.half_m = read_vector(fields, "half_m", d.half_m);
    d.heading_rad = fields.number("heading_rad", 0);
    d.outline = read_outline(fields);
    d.displacement_m = fields.number("displacement_m", 0);
    d.material = read_material(fields);
    return d;
}

SplineDecal read_spline(Fields& fields) {
    SplineDecal s;
    const double width_m = fields.number("width_m", SplinePoint{}.width_m);
    s.fade_m = fields.number("fade_m", s.fade_m);
    s.carve = fields.number("carve", s.carve);
    s.shoulder_m = fields.number("shoulder_m", s.shoulder_m);
    for (const Json& point : fields.list("points")) {
        const size_t size = point.is_array() ? point.size() : 0, index = s.points.size();
        if (size < 2 || size > 5)
            refuse(
                "{}: control point {} must be [x, y], [x, y, z], [x, y, z, width] or [x, y, z, width, roll]",
                fields.place(), index);
        if (size == 2 && s.carve > 0)
            refuse("{}: control point {} has no z, a carve needs every one", fields.place(), index);
        const std::string what = fmt::format("points[{}]", index);
        s.points.push_back({fields.number_of(point[0], what), fields.number_of(point[1], what),
                            size > 2 ? fields.number_of(point[2], what) : 0,
                            size > 3 ? fields.number_of(point[3], what) : width_m,
                            size > 4 ? fields.number_of(point[4], what) : 0});
    }
    s.material = read_material(fields);
    return s;
}

VolumeDecal read_volume(Fields& fields) {
    VolumeDecal v;
    v.center_m = read_vector<glm::dvec3>(fields, fields.need("at"), "at");
    v.half_m = read_vector(fields, "half_m", v.half_m);
    v.direction = read_vector(fields, "direction", v.direction);
    v.roll_rad = fields.number("roll_rad", 0);
    v.deep_edge = fields.number("deep_edge", v.deep_edge);
    v.outline = read_outline(fields);
    v.material = read_material(fields);
    return v;
}

constexpr double kRise_m = 5;  // a flood's, where only the level is given

// The numbers of events by key, and which kinds have them.
constexpr std::pair<const char*, double Event::*> kEventNumbers[] = {
    {"energy_j", &Event::energy_j},   {"radius_m", &Event::radius_m},  {"width_m", &Event::width_m},
    {"volume_m3", &Event::volume_m3}, {"start_s", &Event::start_s},    {"duration_s", &Event::duration_s},
    {"cool_s", &Event::cool_s},       {"weather_s", &Event::weather_s}};

bool has_end(EventKind kind) {
    return kind == EventKind::crater_line || kind == EventKind::crash || kind == EventKind::landslide;
}

bool has(EventKind kind, std::string_view key) {
    using enum EventKind;
    const bool impacts = kind == crater || kind == crater_line || kind == barrage;
    if (key == "energy_j") return impacts;
    if (key == "cool_s" || key == "weather_s") return impacts || kind == crash;
    if (key == "radius_m") return kind == barrage || kind == landslide || kind == flood;
    if (key == "count") return kind == crater_line || kind == barrage || kind == crash;
    if (key == "width_m") return kind == crash;
    if (key == "volume_m3") return kind == landslide;
    return true;
}

constexpr std::pair<const char*, double Life::*> kLifeNumbers[] = {
    {"from_s", &Life::from_s}, {"until_s", &Life::until_s}, {"rise_s", &Life::rise_s},
    {"fade_s", &Life::fade_s}, {"cool_s", &Life::cool_s},   {"weather_s", &Life::weather_s}};

Stamp read_stamp(Fields& fields) {
    Stamp s;
    s.image = fields.text("image");
    s.x_m = fields.number("x");
    s.y_m = fields.number("y");
    s.half_m = read_vector(fields, "half_m", s.half_m);
    s.heading_rad = fields.number("heading_rad", 0);
    s.mode = read_stamp_mode(fields);
    s.height_m = fields.number("height_m", s.height_m);
    s.base_m = fields.number("base_m", s.base_m);
    s.strength = fields.number("strength", s.strength);
    s.edge = fields.number("edge", s.edge);
    if (const Json* layer = fields.find("layer")) s.layer = fields.text_of(*layer, "layer");
    s.layer_from = fields.number("layer_from", s.layer_from);
    s.colour = fields.truth("colour", s.colour);
    return s;
}

// Only what its form has.
Cutout read_cutout(Fields& fields) {
    Cutout c;
    c.form = read_form(fields);
    c.fill = fields.truth("fill", c.fill);
    if (c.form == CutoutForm::brush) {
        c.dabs = read_dabs(fields);
        c.radius_m = fields.number("radius_m", c.radius_m);
    } else if (c.form == CutoutForm::convex) {
        for (const Json& corner : fields.list("corners"))
            c.corners.push_back(read_vector<glm::dvec3>(fields, corner, "corners"));
    } else {
        c.center_m = read_vector<glm::dvec3>(fields, fields.need("at"), "at");
        c.half_m = read_vector(fields, "half_m", c.half_m);
        c.direction = read_vector(fields, "direction", c.direction);
        c.roll_rad = fields.number("roll_rad", 0);
    }
    return c;
}

Slide read_slide(Fields& fields) {
    Slide s;
    s.x_m = fields.number("x");
    s.y_m = fields.number("y");
    s.radius_m = fields.number("radius_m", s.radius_m);
    s.to_m = read_vector<glm::dvec2>(fields, fields.need("to"), "to");
    s.to_radius_m = fields.number("to_radius_m", s.to_radius_m);
    s.volume_m3 = fields.number("volume_m3", s.volume_m3);
    s.way = fields.number("way", s.way);
    return s;
}

Flood read_flood(Fields& fields) {
    Flood f;
    f.x_m = fields.number("x");
    f.y_m = fields.number("y");
    f.radius_m = fields.number("radius_m", f.radius_m);
    f.level_m = fields.number("level_m");
    f.from_m = fields.number("from_m", f.level_m - kRise_m);
    if (const Json* layer = fields.find("layer")) f.layer = fields.text_of(*layer, "layer");
    f.way = fields.number("way", f.way);
    return f;
}

Event read_event(Fields& fields) {
    const std::string name = fields.text("event");
    int kind = 0;
    while (kind < kEventKinds && name_of(EventKind(kind)) != name) ++kind;
    if (kind == kEventKinds) {
        std::string known;
        for (int i = 0; i < kEventKinds; ++i)
            known += fmt::format("{}{}", i ? ", " : "", name_of(EventKind(i)));
        refuse("{}: unknown event \"{}\" (known: {})", fields.place(), name, known);
    }
    Event e = default_event(EventKind(kind));
    e.x_m = fields.number("x");
    e.y_m = fields.number("y");
    if (const Json* to = has_end(e.kind) ? fields.find("to") : nullptr)
        e.to_m = read_vector<glm::dvec2>(fields, *to, "to");
    else if (e.kind == EventKind::crater_line || e.kind == EventKind::crash)
        e.to_m = read_vector<glm::dvec2>(fields, fields.need("to"), "to");
    for (const auto& [key, member] : kEventNumbers)
        if (has(e.kind, key)) e.*member = fields.number(key, e.*member);
    if (has(e.kind, "count")) e.count = int(fields.whole("count", kMostEventParts, uint64_t(e.count)));
    if (e.kind == EventKind::flood) {
        e.level_m = fields.number("level_m");
        e.from_m = fields.number("from_m", e.level_m - kRise_m);
        if (const Json* layer = fields.find("layer")) e.layer = fields.text_of(*layer, "layer");
    }
    e.seed = uint32_t(fields.whole("seed", kMaxU32, 0));
    return e;
}

// Keys of the object "life".
Life read_life(Fields& fields) {
    Life life;
    const Json* json = fields.find("life");
    if (!json) return life;
    Fields of(*json, fields.place() + ": life");
    for (const auto& [key, member] : kLifeNumbers) life.*member = of.number(key, life.*member);
    of.finish();
    return life;
}

void write_decal(Json& json, const TerrainDecal& d) {
    json["x"] = d.x_m;
    json["y"] = d.y_m;
    json["half_m"] = vector_json(d.half_m);
    json["heading_rad"] = d.heading_rad;
    json["outline"] = name_of(d.outline);
    if (d.displacement_m != 0) json["displacement_m"] = d.displacement_m;
    write_material(json, d.material);
}

void write_spline(Json& json, const SplineDecal& s) {
    json["points"] = Json::array();
    for (const SplinePoint& p : s.points) {
        json["points"].push_back({p.x_m, p.y_m, p.z_m, p.width_m});
        if (p.roll_rad != 0) json["points"].back().push_back(p.roll_rad);
    }
    json["fade_m"] = s.fade_m;
    json["carve"] = s.carve;
    json["shoulder_m"] = s.shoulder_m;
    write_material(json, s.material);
}

void write_volume(Json& json, const VolumeDecal& v) {
    json["at"] = vector_json(v.center_m);
    json["half_m"] = vector_json(v.half_m);
    json["direction"] = vector_json(v.direction);
    json["roll_rad"] = v.roll_rad;
    if (v.deep_edge != VolumeDecal{}.deep_edge) json["deep_edge"] = v.deep_edge;
    json["outline"] = name_of(v.outline);
    write_material(json, v.material);
}

void write_stamp(Json& json, const Stamp& s) {
    json["image"] = s.image;
    json["x"] = s.x_m;
    json["y"] = s.y_m;
    json["half_m"] = vector_json(s.half_m);
    json["heading_rad"] = s.heading_rad;
    for (const auto& [name, mode] : kStampModes)
        if (s.mode == mode) json["mode"] = name;
    json["height_m"] = s.height_m;
    json["base_m"] = s.base_m;
    json["strength"] = s.strength;
    json["edge"] = s.edge;
    json["layer"] = s.layer;
    json["layer_from"] = s.layer_from;
    json["colour"] = s.colour;
}

void write_slide(Json& json, const Slide& s) {
    json["x"] = s.x_m;
    json["y"] = s.y_m;
    json["radius_m"] = s.radius_m;
    json["to"] = vector_json(s.to_m);
    json["to_radius_m"] = s.to_radius_m;
    json["volume_m3"] = s.volume_m3;
    json["way"] = s.way;
}

void write_flood(Json& json, const Flood& f) {
    json["x"] = f.x_m;
    json["y"] = f.y_m;
    json["radius_m"] = f.radius_m;
    json["level_m"] = f.level_m;
    json["from_m"] = f.from_m;
    json["layer"] = f.layer;
    json["way"] = f.way;
}

void write_event(Json& json, const Event& e) {
    json["event"] = name_of(e.kind);
    json["x"] = e.x_m;
    json["y"] = e.y_m;
    if (e.to_m && has_end(e.kind)) json["to"] = vector_json(*e.to_m);
    for (const auto& [key, member] : kEventNumbers)
        if (has(e.kind, key)) json[key] = e.*member;
    if (has(e.kind, "count")) json["count"] = e.count;
    if (e.kind == EventKind::flood) {
        json["level_m"] = e.level_m;
        json["from_m"] = e.from_m;
        json["layer"] = e.layer;
    }
    json["seed"] = e.seed;
}

void write_life(Json& json, const Life& life) {
    const Life ever;
    for (const auto& [key, member] : kLifeNumbers)
        if (life.*member != ever.*member) json["life"][key] = life.*member;
}

void write_cutout(Json& json, const Cutout& c) {
    for (const auto& [name, form] : kCutoutForms)
        if (c.form == form) json["form"] = name;
    json["fill"] = c.fill;
    if (c.form == CutoutForm::brush) {
        json["dabs"] = dabs_json(c.dabs);
        json["radius_m"] = c.radius_m;
    } else if (c.form == CutoutForm::convex) {
        json["corners"] = Json::array();
        for (const glm::dvec3& corner : c.corners) json["corners"].push_back(vector_json(corner));
    } else {
        json["at"] = vector_json(c.center_m);
        json["half_m"] = vector_json(c.half_m);
        json["direction"] = vector_json(c.direction);
        json["roll_rad"] = c.roll_rad;
    }
}

}  // namespace loam
