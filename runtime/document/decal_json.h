// The parameters of decals, splines, volumes, stamps and cutouts as JSON, both ways. Internal to this folder;
// what it throws ends in json_text.cpp.
#pragma once

#include "runtime/document/cutout.h"
#include "runtime/document/earth.h"
#include "runtime/document/event.h"
#include "runtime/document/ground_decal.h"
#include "runtime/document/json_fields.h"
#include "runtime/document/life.h"
#include "runtime/document/stamp.h"

namespace loam {

[[nodiscard]] TerrainDecal read_decal(Fields& fields);
[[nodiscard]] Slide read_slide(Fields& fields);
[[nodiscard]] Flood read_flood(Fields& fields);
[[nodiscard]] Event read_event(Fields& fields);
void write_slide(Json& json, const Slide& slide);
void write_flood(Json& json, const Flood& flood);
void write_event(Json& json, const Event& event);

// The object "life"; none: there at any time.
[[nodiscard]] Life read_life(Fields& fields);
void write_life(Json& json, const Life& life);  // nothing for one that is there at any time

[[nodiscard]] SplineDecal read_spline(Fields& fields);
[[nodiscard]] VolumeDecal read_volume(Fields& fields);
[[nodiscard]] Stamp read_stamp(Fields& fields);
[[nodiscard]] Cutout read_cutout(Fields& fields);
void write_decal(Json& json, const TerrainDecal& decal);
void write_spline(Json& json, const SplineDecal& spline);
void write_volume(Json& json, const VolumeDecal& volume);
void write_stamp(Json& json, const Stamp& stamp);
void write_cutout(Json& json, const Cutout& cutout);
// Places seen from above, [[x, y], …].
[[nodiscard]] std::vector<glm::dvec2> read_dabs(Fields& fields);
[[nodiscard]] Json dabs_json(const std::vector<glm::dvec2>& dabs);

}  // namespace loam
