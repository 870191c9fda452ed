// The functions of procedural decals: in the project's shaders this file is made of their texts (document/decal_function.h). Here
// there is none.
const bool kDecalFunctions = false;
void run_function(PaintDecal decal, fn_Place at, inout fn_Surface s) {}
