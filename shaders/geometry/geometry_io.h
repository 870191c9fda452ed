// Terrain patches. A patch is one page of the height map drawn as a grid of kPatchQuads² quads.
// Positions are whole steps of the finest patch grid relative to a step near the camera: both patches that share a
// vertex compute the same float from the same integer, so there is no crack between levels.
//
// The last patches may extend beyond the map: their vertices are moved back onto the map's edge, where heights
// (clamped beyond the edge) are the same, and the triangles that lay beyond collapse to nothing.
#ifndef LOAM_GEOMETRY_IO_H
#define LOAM_GEOMETRY_IO_H
#include "shaders/base/shared.h"
#include "shaders/geometry/cutout_io.h"
LOAM_BEGIN_SHARED

#define kPatchQuads 8
#define kPatchQuadTexels 8  // height samples a quad
#define kPatchBorder 2      // texels of a page before its first sample
#define kPatchTexels 68     // texels a side of a page

struct PatchInstance {
    ivec2 origin;      // south-west vertex, in finest grid steps from the view's origin step
    int stride;        // finest grid steps between vertices: 2^level
    uint slot;         // layer of the height and normal arrays
    uint lod_deltas;   // how many levels coarser the neighbour is: 4 bits each, north << 12 | east << 8 | south << 4 | west
    uint level;        // for debug views
};

struct GeometryPush {
    mat4 clip_from_rel;   // camera-relative metres to clip space
    vec2 origin_rel_m;    // where the view's origin step lies, camera-relative x, y
    float step_m;         // metres of a finest grid step
    float camera_z_m;     // subtracted from heights
    uint first_instance;  // added to the instance index
    vec2 map_edge_rel_m;  // the map's north-east corner, camera-relative x, y
    CutoutPush cutout;    // of patches with holes
};

LOAM_END_SHARED
#endif
