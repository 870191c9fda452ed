// The parameters of decals, splines and volumes as JSON, both ways. Internal to this folder; what it throws
// ends in json_text.cpp.
#pragma once

#include "runtime/document/ground_decal.h"
#include "runtime/document/json_fields.h"
#include "runtime/document/stamp.h"

namespace loam {

[[nodiscard]] TerrainDecal read_decal(Fields& fields);
[[nodiscard]] SplineDecal read_spline(Fields& fields);
[[nodiscard]] VolumeDecal read_volume(Fields& fields);
[[nodiscard]] Stamp read_stamp(Fields& fields);
void write_decal(Json& json, const TerrainDecal& decal);
void write_spline(Json& json, const SplineDecal& spline);
void write_volume(Json& json, const VolumeDecal& volume);
void write_stamp(Json& json, const Stamp& stamp);

}  // namespace loam
