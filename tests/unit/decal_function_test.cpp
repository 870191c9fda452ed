// Functions of decals: what a text may say, the sentence for what it may not, and that the version shown
// stays until the next one compiles.
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "document_fixture.h"
#include "runtime/document/decal_function.h"
#include "runtime/document/function_library.h"

namespace {

using namespace loam;
using test::create_small;
using test::take;
using test::TemporaryFolder;

std::string with_body(const std::string& body) {
    return "void decal(Place at, inout Surface s) {\n" + body + "\n}\n";
}

Status check(const std::string& text) {
    const auto function = read_function("f", text);
    return function.ok() ? compile_function(*function) : function.error();
}

std::string refusal(const std::string& text) {
    const Status status = check(text);
    return status.ok() ? "accepted" : status.message();
}

// Saved as another program would; the file's time is another for certain.
void save(const std::filesystem::path& file, const std::string& text) {
    std::error_code none;
    const auto before = std::filesystem::last_write_time(file, none);
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::trunc) << text;
    if (!none) std::filesystem::last_write_time(file, before + std::chrono::seconds(2));
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(DecalFunction, TheShippedOnesCompileAndSayWhatTheyAre) {
    EXPECT_GE(shipped_functions().size(), 12u);
    for (const auto& [name, text] : shipped_functions()) {
        const auto function = read_function(name, text);
        ASSERT_TRUE(function.ok()) << function.message();
        const Status compiled = compile_function(*function);
        EXPECT_TRUE(compiled.ok()) << compiled.message();
        EXPECT_FALSE(function->says.empty()) << name;
        EXPECT_GE(function->parameters.size(), 3u) << name;
        for (const FunctionParameter& p : function->parameters)
            EXPECT_FALSE(p.says.empty()) << name << p.name;
    }
}

TEST(DecalFunction, AllTogetherMakeOneShader) {
    std::vector<DecalFunction> functions;
    for (const auto& [name, text] : shipped_functions()) functions.push_back(take(read_function(name, text)));
    std::vector<const DecalFunction*> list;
    for (const DecalFunction& f : functions) list.push_back(&f);
    const auto words =
        glsl::compile_with("frame/resolve_direct.frag", shader_texts(list), glsl::embedded_text);
    EXPECT_TRUE(words.ok()) << words.message();
    // The same names in two texts, and one that the shader has itself.
    const std::string clash =
        "const float SIZE = 1.0;\nfloat bed(vec2 paint_edge) { return paint_edge.x; }\n" +
        with_body("float heights = SIZE * bed(at.p); s.gloss = heights;");
    const DecalFunction a = take(read_function("a", clash)), b = take(read_function("b", clash));
    const DecalFunction* both[] = {&a, &b};
    EXPECT_TRUE(glsl::compile_with("texture/paint.frag", shader_texts(both), glsl::embedded_text).ok());
}

TEST(DecalFunction, WhatItMayNotDoIsSaidAtItsLine) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"", "decals/f.glsl:1: there is no \"void decal(Place at, inout Surface s)\" in it"},
        {"void decal(Place at) {}", "decals/f.glsl:1: decal is \"void decal(Place at, inout Surface s)\""},
        {"\nfloat relief(float x) { return x; }\n" + with_body(""),
         "decals/f.glsl:2: relief is \"float relief(Place at)\""},
        {with_body("  s.colour = vec3(x);"), "decals/f.glsl:2: 'x' : undeclared identifier"},
        {with_body("\n\n  s.gloss = 1.0"), "decals/f.glsl:5: "},
        {with_body("while (true) {}"),
         "decals/f.glsl:2: while has no bound: a loop is \"for (int i = 0; i < 8; ++i) { … }\""},
        {with_body("for (int i = 0; i < 9; ++i) { i -= 1; }"),
         "decals/f.glsl:2: i counts the turns of a loop and cannot be changed in it"},
        {with_body("for (int i = 0; i < 9; ++i) { ++i; }"), "decals/f.glsl:2: i counts the turns"},
        {with_body("for (int i = 0; i < int(at.p.x); ++i) { }"), "decals/f.glsl:2: a loop is \"for ("},
        {with_body("for (int i = 0; i < 9; i += 0) { }"), "decals/f.glsl:2: a loop is \"for ("},
        {with_body("for (float i = 0.0; i < 9.0; ++i) { }"), "decals/f.glsl:2: a loop is \"for ("},
        {with_body("for (;;) { }"), "decals/f.glsl:2: a loop is \"for ("},
        {with_body("if (true) for (int i = 0; i < 9; ++i) { }"), "accepted"},
        {with_body("for (int i = 0; i < 257; ++i) { }"),
         "decals/f.glsl:2: a loop of 257 turns, the limit is 256"},
        {with_body("for (int i = 0; i < 200; ++i) { for (int j = 0; j < 200; ++j) { s.gloss += 0.1; } }"),
         "decals/f.glsl:1: it may take 240000 steps at a place, the limit is 60000: fewer turns of its "
         "loops"},
        {"float f(float x) { return f(x); }\n" + with_body(""), "decals/f.glsl:1: f cannot be called"},
        {"float f(float x);\n" + with_body(""), "decals/f.glsl:1: f has no body"},
        {"void decal(Place at, inout Surface s) { f(); }\nvoid f() {}",
         "decals/f.glsl:1: f cannot be called"},
        {with_body("s.colour = texture(layer_albedo, vec3(0)).rgb;"),
         "decals/f.glsl:2: \"texture\" has no place in a decal's function"},
        {with_body("s.gloss = heights[3];"), "decals/f.glsl:2: 'heights' : undeclared identifier"},
        {with_body("s.gloss = decal_fade(1.0, 1.0);"), "decals/f.glsl:2: decal_fade cannot be called"},
        {with_body("s.gloss = noise_value(at.p, 1u);"), "decals/f.glsl:2: noise_value cannot be called"},
        {with_body("s.gloss = gl_FragCoord.x;"), "decals/f.glsl:2: 'gl_FragCoord' : undeclared identifier"},
        {with_body("s.gloss = dFdx(at.p.x);"), "decals/f.glsl:2: dFdx cannot be called"},
        {with_body("atomicAdd(failed_texels, 1u);"), "decals/f.glsl:2: atomicAdd cannot be called"},
        {with_body("discard;"), "decals/f.glsl:2: \"discard\" has no place in a decal's function"},
        {with_body("int i = int(at.p.x); float a[4]; s.gloss = a[i];"),
         "decals/f.glsl:2: there are no arrays, and what stands in [ ] must be a number"},
        {with_body("int i = int(at.p.x); s.gloss = at.p[i];"), "decals/f.glsl:2: there are no arrays"},
        {with_body("int i = int(at.p.x);\n s.gloss = float(7 / i);"), "decals/f.glsl:3: dividing int by int"},
        {"int part(ivec2 a) { return (a % 3).x; }\n" + with_body("s.gloss = float(part(ivec2(at.p)));"),
         "decals/f.glsl:1: dividing int by int"},
        {"#include \"shaders/texture/paint_io.h\"\n" + with_body(""),
         "decals/f.glsl:1: a decal's function has no directives (#)"},
        {"// a \\\n#define X\n" + with_body(""), "decals/f.glsl:2: a decal's function has no directives (#)"},
        {"float b = 1.0;\n" + with_body(""), "decals/f.glsl:1: outside of functions there are only"},
        {"uniform float b;\n" + with_body(""), "decals/f.glsl:1: outside of functions there are only"},
        {"struct A { float b; };\n" + with_body(""), "decals/f.glsl:1: outside of functions there are only"},
        {"void f(out int i) { i = 0; }\n" + with_body(""),
         "decals/f.glsl:1: a function cannot give back int"},
        {"float noise(float x) { return x; }\n" + with_body(""),
         "decals/f.glsl:1: noise cannot be defined again"},
        {with_body("if (true) {"), "decals/f.glsl:1: this \"{\" is never closed"},
        {with_body("s.gloss = \"a\";"), "decals/f.glsl:2: there is no place for this character here"},
        {"/* void decal", "decals/f.glsl:1: there is no \"void decal"},
        {"//@ a\n", "decals/f.glsl:1: a parameter is \"//@ name value min max what it is\""},
        {"//@ a nan 0 1\n", "decals/f.glsl:1: \"nan\" of the parameter a is no number within"},
        {"//@ a 1e9 0 1\n", "decals/f.glsl:1: \"1e9\" of the parameter a is no number within"},
        {"//@ a 2 0 1\n", "decals/f.glsl:1: the parameter a is 2 in a range of 0 … 1"},
        {"//@ mix 0 0 1\n", "decals/f.glsl:1: \"mix\" is no name for a parameter"},
        {"//@ a 0 0 1\n//@ a 0 0 1\n", "decals/f.glsl:2: the parameter a is there twice"},
    };
    for (const auto& [text, message] : cases)
        EXPECT_TRUE(refusal(text).starts_with(message)) << text << "\n" << refusal(text);
    std::string nine;
    for (char c = 'a'; c < 'j'; ++c) nine += std::string("//@ ") + c + " 0 0 1\n";
    EXPECT_EQ(refusal(nine), "decals/f.glsl:9: the limit is 8 parameters");
    // What would have a compiler walk to the end of its stack.
    const auto times = [](int count, const std::string& text) {
        std::string all;
        for (int i = 0; i < count; ++i) all += text;
        return all;
    };
    for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
             {times(30'000, "{") + times(30'000, "}"), "more than 64 blocks in one another"},
             {"s.gloss = " + times(9'000, "(") + "1.0" + times(9'000, ")") + ";", "more than 64 brackets"},
             {"float a = 0.0; " + times(25'000, "a,") + "a;", "a statement of more than 2000 words"},
             {"s.gloss = at.p.x" + times(6'000, " + at.p.x") + ";", "a statement of more than 2000 words"},
             {times(65, "if (at.p.x > 1.0) "), "more than 64 brackets, ifs"},
             {times(2'000, "if (at.p.x > 1.0); else ") + ";", "more than 64 brackets, ifs or elses"},
             {times(300, "if (at.p.x > 1.0) { } else ") + "{ }", "more than 64 brackets, ifs or elses"}})
        EXPECT_NE(refusal(with_body(text)).find(message), std::string::npos) << refusal(with_body(text));
    EXPECT_EQ(refusal(with_body(times(200, "if (at.p.x > 1.0) { s.gloss = 0.1; } else { s.gloss = 0.2; }\n"))), "accepted");
    EXPECT_EQ(refusal(with_body(times(60, "if (at.p.x > 1.0) { s.gloss = 0.1; } else ") + ";")), "accepted");
    EXPECT_TRUE(refusal(std::string(70'000, ' ')).find("70000 bytes, the limit is 65536") !=
                std::string::npos);
    EXPECT_TRUE(refusal(std::string("\0\x01\xff", 3)).starts_with("decals/f.glsl:1: "));
    for (const char* name : {"", "../x", "a b", ".x", "a/b"})
        EXPECT_FALSE(check_function_name(name).ok()) << name;
}

TEST(DecalFunction, WhatItMayDoCompiles) {
    for (const char* body :
         {"const int N = 4; for (int i = -2; i <= N - N; ++i) { }",  // a bound that is not a number
          "uint a = uint(at.p.x) / 3u % 7u; s.gloss = float(a);",
          "switch (int(at.p.x)) { case 0: s.gloss = 1.0; break; default: break; }",
          "for (int i = 0; i < 4; i += 2) { for (int j = 3; j <= 5; j++) { if (j == 4) continue; s.gloss += "
          "0.01; } }",
          "mat2 turn = mat2(0.8, 0.6, -0.6, 0.8); s.slope = turn * s.slope; s.colour.rb *= turn[0].x;",
          "s.cover = cells(at.p, at.seed).y * fbm(at.p, at.seed, 4) * random(at.p, at.seed) * detail(0.1, "
          "at);"}) {
        const bool bad = std::string(body).starts_with("const int N");
        EXPECT_EQ(check(with_body(body)).ok(), !bad) << body << refusal(with_body(body));
    }
    EXPECT_EQ(refusal("const int N = 4;\n" + with_body("for (int i = 0; i < N; ++i) { s.gloss += 0.1; }")),
              "accepted");
    EXPECT_EQ(refusal("//@ a 1 0 2 it\n// \"quoted\" # and //@ inside\n" + with_body("s.gloss = a; /* # */")),
              "accepted");
}

TEST(DecalFunction, ParametersAreCheckedAndHaveTheTextsValues) {
    const auto f =
        take(read_function("f", "//@ a 0.5 0 1 it\n//@ b -3 -5 5 that\n" + with_body("s.gloss = a * b;")));
    EXPECT_EQ(parameter_values(f, {}), (std::vector<double>{0.5, -3}));
    EXPECT_EQ(parameter_values(f, {{"b", 4}, {"gone", 1}}), (std::vector<double>{0.5, 4}));
    EXPECT_EQ(parameter_values(f, {{"b", 40}}), (std::vector<double>{0.5, 5}))
        << "the range was another when it was set";
    EXPECT_EQ(check_parameters(f, {{"c", 1}}).message(),
              "the function f has no parameter \"c\" (it has: a, b)");
    EXPECT_EQ(check_parameters(f, {{"a", 3}}).message(), "the parameter a of f is 3, must be 0 … 1");
}

TEST(DecalFunction, TheVersionBeforeStaysUntilTheNextCompiles) {
    const TemporaryFolder folder;
    FunctionLibrary library(folder.path());
    EXPECT_FALSE(library.find("mine").ok());
    const std::string first = with_body("s.gloss = 0.1;"), second = with_body("s.gloss = 0.2;");
    ASSERT_TRUE(library.set("mine", first).ok());
    const auto shown = library.shown("mine");
    ASSERT_TRUE(shown);
    EXPECT_EQ(text_of(library.file_of("mine")), first);

    EXPECT_FALSE(library.set("mine", with_body("s.gloss = nothing;")).ok());
    EXPECT_EQ(library.shown("mine"), shown);
    EXPECT_EQ(text_of(library.file_of("mine")), first) << "what does not compile is not saved over what does";

    save(library.file_of("mine"), with_body("s.gloss = nothing;"));
    EXPECT_TRUE(library.poll().empty());
    EXPECT_EQ(library.shown("mine"), shown);
    EXPECT_TRUE(library.errors().at("mine").starts_with("decals/mine.glsl:2: 'nothing'"))
        << library.errors().at("mine");
    EXPECT_TRUE(library.poll().empty());

    save(library.file_of("mine"), second);
    EXPECT_EQ(library.poll(), std::vector<std::string>{"mine"});
    EXPECT_TRUE(library.errors().empty());
    EXPECT_EQ(library.shown("mine")->text, second);
    EXPECT_GT(library.shown("mine")->revision, shown->revision);

    std::filesystem::remove(library.file_of("mine"));
    EXPECT_TRUE(library.poll().empty());
    EXPECT_EQ(library.shown("mine")->text, second);
    EXPECT_NE(library.errors().at("mine").find("is gone"), std::string::npos);
    save(library.file_of("mine"), second);
    EXPECT_EQ(library.poll(), std::vector<std::string>{"mine"}) << "it is back";
    EXPECT_TRUE(library.errors().empty());

    // What was being written and does not compile is kept beside it, until something does.
    EXPECT_EQ(library.draft("mine"), std::nullopt);
    const std::string unfinished = with_body("s.gloss = ");
    ASSERT_TRUE(library.keep_draft("mine", unfinished).ok());
    EXPECT_EQ(FunctionLibrary(folder.path()).draft("mine"), unfinished);
    EXPECT_EQ(FunctionLibrary(folder.path()).text("mine").value(), second);
    ASSERT_TRUE(library.set("mine", first).ok());
    EXPECT_EQ(library.draft("mine"), std::nullopt);
}

TEST(DecalFunction, ADocumentKeepsItsOwnCopyAndDirtIsWhereItShows) {
    const TemporaryFolder folder;
    auto document = create_small(folder.path() / "p");
    const auto decal = [](double x_m, const std::string& function) {
        TerrainDecal d{.x_m = x_m, .y_m = 50, .half_m = {4, 4}};
        d.material.function = function;
        return d;
    };
    (void)take(document->apply({AddOperatorCommand{decal(50, "moss"), {}}}));
    (void)take(document->apply({AddOperatorCommand{decal(150, "oil"), {}}}));
    EXPECT_EQ(text_of(document->functions().file_of("moss")), *document->functions().text("moss"));
    EXPECT_FALSE(std::filesystem::exists(document->functions().file_of("frost")));

    const uint64_t revision = document->revision();
    const Dirt dirt = take(document->apply({FunctionCommand{"moss", with_body("s.gloss = 0.5;")}}));
    ASSERT_EQ(dirt.texture.size(), 1u);
    EXPECT_TRUE(dirt.texture[0].overlaps({46, 46, 54, 54}));
    EXPECT_FALSE(dirt.texture[0].overlaps({100, 0, 200, 100}));
    EXPECT_TRUE(dirt.height.empty() && dirt.index.empty() && dirt.cutout.empty());
    EXPECT_GT(document->revision(), revision);
    EXPECT_FALSE(document->apply({FunctionCommand{"moss", "nonsense"}}).ok());

    // A decal stays what it is though its text has lost a parameter; nothing new may name it.
    TerrainDecal with = decal(60, "oil");
    with.material.parameters = {{"sheen", 0.2}};
    (void)take(document->apply({AddOperatorCommand{with, {}}}));
    (void)take(document->apply({FunctionCommand{"oil", with_body("s.gloss = 0.9;")}}));
    with.x_m = 70;
    EXPECT_TRUE(document->apply({EditOperatorCommand{3, with, {}}}).ok());
    with.material.parameters = {{"sheen", 0.3}};
    EXPECT_EQ(document->apply({EditOperatorCommand{3, with, {}}}).message(),
              "the function oil has no parameter \"sheen\" (it has: none)");
    EXPECT_NE(
        document->apply({AddOperatorCommand{decal(9, "none such"), {}}}).message().find("is no name of"),
        std::string::npos);
    EXPECT_NE(document->apply({AddOperatorCommand{decal(9, "nothing"), {}}})
                  .message()
                  .find("unknown function \"nothing\" (known: cracks, "),
              std::string::npos);

    // Another program breaks a text and the project is opened: it opens, and verify says where.
    const std::filesystem::path file = document->functions().file_of("moss");
    document.reset();
    EXPECT_EQ(
        take(Document::verify(folder.path() / "p")),
        (std::vector<std::string>{"operator 3: the function oil has no parameter \"sheen\" (it has: none)"}));
    save(file, with_body("\n\n  s.gloss = gone;"));
    const auto faults = take(Document::verify(folder.path() / "p"));
    ASSERT_EQ(faults.size(), 2u);
    EXPECT_TRUE(faults[0].starts_with("decals/moss.glsl:4: 'gone' : undeclared identifier")) << faults[0];
    document = take(Document::open(folder.path() / "p"));
    EXPECT_EQ(document->functions().shown("moss"), nullptr);
    save(file, with_body("s.gloss = 0.7;"));
    EXPECT_EQ(document->poll_functions().texture.size(), 1u);
    EXPECT_NE(document->functions().shown("moss"), nullptr);
}

}  // namespace
