// Procedural decals: a function of the place on a decal, its seed and its parameters, as text. It takes no
// texture memory. Source: Call of Duty talk, "Procedural Decals".
//
// A text is GLSL of constants and functions, among them
//
//     void decal(Place at, inout Surface s)     what the decal shows there
//     float relief(Place at)                    optional: heights in metres, of which normals are made
//
// and lines "//@ name value min max what it is" for at most eight parameters, numbers that each decal may
// set.
//
// What a text may do is little, so that a project of somebody else's can be opened: it calls its own
// functions, arithmetic and those of shaders/texture/function_calls.glsl; it sees no image, no buffer, no
// other shader's names; every loop has a bound written down, nothing calls itself, and the steps of the
// worst case have a limit.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/glsl/compiler.h"

namespace loam {

struct FunctionParameter {
    std::string name, says;
    double value = 0, min = 0, max = 1;
};

inline constexpr size_t kMostFunctionParameters = 8;
inline constexpr size_t kLargestFunction_bytes = 65'536;
inline constexpr int64_t kMostFunctionSteps = 60'000;  // tokens executed a texel in the worst case

struct DecalFunction {
    std::string name;
    std::string says;  // its first line, when that is a comment
    std::string text;
    std::vector<FunctionParameter> parameters;
    bool has_relief = false;
    int64_t steps = 0;      // in the worst case
    uint64_t revision = 0;  // another text, another number (function_library.h)
};

// Letters, digits, _ and -.
[[nodiscard]] Status check_function_name(const std::string& name);

// What a text says of itself, once it keeps to the rules. An error begins with "decals/NAME.glsl:LINE: ".
[[nodiscard]] Result<DecalFunction> read_function(const std::string& name, std::string text);

// Whether the function has all of them and they are in its ranges.
[[nodiscard]] Status check_parameters(const DecalFunction& function,
                                      const std::map<std::string, double>& parameters);
// Of the decal's parameters, the text's where it sets none; one for each of the function's.
[[nodiscard]] std::vector<double> parameter_values(const DecalFunction& function,
                                                   const std::map<std::string, double>& parameters);

// For the shader compiler: the texts that put these functions into shaders that draw decals;
// PaintDecal::function is the place in the list, from 1. Names of a text are put out of the way of everybody
// else's.
[[nodiscard]] glsl::Texts shader_texts(std::span<const DecalFunction* const> functions);

// Compiles it as it is drawn. An error begins with "decals/NAME.glsl:LINE: ".
[[nodiscard]] Status compile_function(const DecalFunction& function);
// A compiler's message about such a shader, with the names that stand in the text.
[[nodiscard]] std::string plain_message(const std::string& message);

// The names and texts that come with Loam, sorted by name.
[[nodiscard]] std::span<const std::pair<std::string, std::string>> shipped_functions();

}  // namespace loam
