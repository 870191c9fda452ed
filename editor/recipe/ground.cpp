#include "editor/recipe/ground.h"

#include <cmath>

#include "editor/recipe/ground_shapes.h"

namespace loam {

namespace {

constexpr int kMostSamples = 2101;  // 16.8 km at 8 m

using ShapeFunction = Result<recipe::Shape> (*)(const recipe::ShapeRequest&, const Progress&);

ShapeFunction shape_function(const std::string& name) {
    if (name == "valley") return recipe::shape_valley;
    if (name == "ridge") return recipe::shape_ridge;
    if (name == "hills") return recipe::shape_hills;
    if (name == "dunes") return recipe::shape_dunes;
    if (name == "plain") return recipe::shape_plain;
    return nullptr;
}

}  // namespace

const std::vector<RecipeName>& ground_recipe_names() {
    static const std::vector<RecipeName> names = {
        {"valley",
         "an alpine valley: ridges and tributaries, scree at the foot of rock, a flat floor with fans"},
        {"ridge", "a mountain crest across the map, draining to all sides"},
        {"hills", "gentle soil-mantled hills with hollows and small streams"},
        {"dunes", "a field of sand dunes with slip faces"},
        {"plain", "nearly flat ground, made at once"},
    };
    return names;
}

double recipe_spacing_m(double size_m) {
    double spacing = 0.5;
    while (spacing < 8 && std::lround(size_m / spacing) + 1 > kMostSamples) spacing *= 2;
    return spacing;
}

Result<GroundMaps> make_ground(const RecipeRequest& request, const Progress& progress) {
    const ShapeFunction shape_of = shape_function(request.name);
    if (!shape_of) {
        std::string names;
        for (const RecipeName& n : ground_recipe_names())
            names += (names.empty() ? "" : ", ") + std::string(n.name);
        return error("there is no recipe \"{}\"; there are {}", request.name, names);
    }
    if (!(request.size_m >= 64 && request.size_m <= 16800))
        return error("a size of {} m is outside 64 … 16800 m", request.size_m);

    GroundMaps maps;
    maps.spacing_m = recipe_spacing_m(request.size_m);
    maps.size = static_cast<int>(std::lround(request.size_m / maps.spacing_m)) + 1;
    auto shape = shape_of({.size = maps.size, .spacing_m = maps.spacing_m, .seed = request.seed},
                          part_of(progress, 0, 0.9));
    if (!shape) return shape.error();

    LOAM_TRY(step_progress(progress, 0.92, "following the water"));
    recipe::Drainage drainage =
        recipe::route(shape->height_m, maps.spacing_m, recipe::Outlets::all_edges, request.seed | 1u);
    maps.flow_m2 = std::move(drainage.area_m2.v);
    maps.slope = recipe::slope_of(shape->height_m, maps.spacing_m).v;
    maps.curvature = recipe::curvature_of(shape->height_m, maps.spacing_m).v;
    maps.height_m = std::move(shape->height_m.v);
    maps.deposit_m = std::move(shape->deposit_m.v);
    LOAM_TRY(step_progress(progress, 1.0, "ground made"));
    return maps;
}

}  // namespace loam
