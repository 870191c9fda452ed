// Commands as JSON, and brush falloff.
#include "document_fixture.h"

using namespace loam;
using namespace loam::test;

TEST(command, comes_back_from_json_as_it_was) {
    std::mt19937 random(9);
    for (int i = 0; i < 500; ++i) {
        Command command = random_command(random, 1000);
        command.group = random() % 3 == 0 ? random() : 0;
        const std::string json = to_json(command);
        const auto parsed = parse_command(json);
        ASSERT_TRUE(parsed.ok()) << json << ": " << parsed.message();
        ASSERT_EQ(to_json(*parsed), json);
        ASSERT_EQ(parsed->body.index(), command.body.index());
        if (const auto* sculpt = std::get_if<SculptCommand>(&command.body)) {
            ASSERT_EQ(std::get<SculptCommand>(parsed->body).dabs, sculpt->dabs) << "bit for bit";
        }
        if (const auto* prints = std::get_if<FootprintsCommand>(&command.body)) {
            for (size_t k = 0; k < prints->prints.size(); ++k) {
                ASSERT_EQ(std::get<FootprintsCommand>(parsed->body).prints[k].seed, prints->prints[k].seed);
            }
        }
    }
    EXPECT_EQ(to_json({UndoCommand{}}), R"({"cmd":"undo"})");
    EXPECT_EQ(to_json({RedoCommand{}, 4}), R"({"cmd":"redo","group":4})");
}

TEST(command, the_examples_of_the_header_parse) {
    for (
        const char* json :
        {R"({"cmd":"sculpt","mode":"raise","dabs":[[1,2],[3,4]],"radius_m":10,"strength_m":0.5,"hardness":0.5})",
         R"({"cmd":"sculpt","mode":"flatten","dabs":[[1,2]],"strength":1,"target_m":4})",
         R"({"cmd":"paint","dabs":[[1,2]],"radius_m":5,"layer":"rock","strength":1,"hardness":0.5,"seed":1,
                 "min_slope_rad":0,"max_slope_rad":1.5708,"tint":[0.5,1,0]})",
         R"({"cmd":"paint","dabs":[[1,2]],"layer":"rock","min_height_m":-4,"max_height_m":900.5,"noise":0.5,"noise_size_m":20})",
         R"({"cmd":"fill","rect":[0,0,100,50],"layer":"rock","replace":"grass","tint":[1,1,0],"strength":0.5,"seed":3})",
         R"({"cmd":"fill","layer":"rock","min_slope_rad":0.5})",
         R"({"cmd":"crater","x":1,"y":2,"radius_m":10,"depth_m":4,"seed":7})",
         R"({"cmd":"crater","x":1,"y":2,"radius_m":10,"heat":0.8})",
         R"({"cmd":"footprints","prints":[{"x":1,"y":2,"heading_rad":0.1,"foot":0}],"length_m":0.3,"depth_m":0.03,"seed":1})",
         R"({"cmd":"operator","id":12,"enabled":false})", R"({"cmd":"remove","id":12,"group":3})",
         R"({"cmd":"transition","name":"edge","from":"grass","to":"rock","threshold":0.5})",
         R"({"cmd":"transition","name":"edge","remove":true})", R"({"cmd":"undo"})"}) {
        const auto command = parse_command(json);
        EXPECT_TRUE(command.ok()) << json << ": " << (command.ok() ? "" : command.message());
    }
}

TEST(command, a_hot_crater_comes_back_and_a_cold_one_reads_as_before) {
    const auto hot = parse_command(R"({"cmd":"crater","x":1,"y":2,"heat":0.8})");
    ASSERT_TRUE(hot.ok());
    EXPECT_EQ(std::get<CraterCommand>(hot->body).crater.heat, 0.8);
    const auto again = parse_command(to_json(*hot));
    ASSERT_TRUE(again.ok());
    EXPECT_EQ(std::get<CraterCommand>(again->body).crater.heat, 0.8);
    EXPECT_EQ(to_json({CraterCommand{{.x_m = 1}}}).find("heat"), std::string::npos);
}

TEST(command, errors_are_one_sentence) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "not valid JSON, at byte 1"},
        {"{\"cmd\":", "not valid JSON, at byte 8"},
        {"[]", "a command must be an object, found array"},
        {"{}", "a command: \"cmd\" is missing"},
        {R"({"cmd":5})", "a command: \"cmd\" must be a text, found number"},
        {R"({"cmd":"foo"})",
         "unknown command \"foo\" (known: sculpt, paint, fill, crater, footprints, decal, spline, volume, "
         "stamp, cutout, slide, flood, event, edit, reorder, operator, remove, transition, time, "
         "function, undo, redo)"},
        {R"({"cmd":"transition"})", "transition: \"name\" is missing"},
        {R"({"cmd":"transition","name":""})", "a transition needs a name"},
        {R"({"cmd":"transition","name":"a","threshold":-1})", "threshold is -1, must be 0 … 1"},
        {R"({"cmd":"transition","name":"a","remove":true,"from":"b"})",
         "\"remove\" of a transition stands alone"},
        {R"({"cmd":"undo","x":1})", "undo: unknown key \"x\" (known: cmd, group)"},
        {R"({"cmd":"sculpt","dabs":[]})", "sculpt: \"mode\" is missing"},
        {R"({"cmd":"sculpt","mode":"dig","dabs":[]})",
         "sculpt: unknown mode \"dig\" (known: raise, lower, smooth, flatten)"},
        {R"({"cmd":"sculpt","mode":"raise"})", "sculpt: \"dabs\" is missing"},
        {R"({"cmd":"sculpt","mode":"raise","dabs":7})", "sculpt: \"dabs\" must be a list, found number"},
        {R"({"cmd":"sculpt","mode":"raise","dabs":[[1]]})", "sculpt: dab 0 must be [x, y]"},
        {R"({"cmd":"sculpt","mode":"raise","dabs":[[1,2],[1,"a"]]})",
         "sculpt: \"dabs[1]\" must be a number, found string"},
        {R"({"cmd":"sculpt","mode":"raise","dabs":[[1,null]]})",
         "sculpt: \"dabs[0]\" must be a number, found null"},
        {R"({"cmd":"sculpt","mode":"raise","dabs":[[1,NaN]]})", "not valid JSON, at byte"},
        {R"({"cmd":"sculpt","mode":"raise","dabs":[[1,1e999]]})", "not valid JSON"},
        {R"({"cmd":"sculpt","mode":"raise","dabs":[[1,1e7]]})", "dab 0 is at (1, 10000000)"},
        {R"({"cmd":"sculpt","mode":"raise","dabs":[],"radius_m":0})", "radius_m is 0, must be 0.01 … 5000"},
        {R"({"cmd":"sculpt","mode":"raise","dabs":[],"strength_m":-1})",
         "strength_m is -1, must be 0 … 32768"},
        {R"({"cmd":"sculpt","mode":"smooth","dabs":[],"strength":2})", "strength is 2, must be 0 … 1"},
        {R"({"cmd":"sculpt","mode":"flatten","dabs":[]})", "sculpt: \"target_m\" is missing"},
        {R"({"cmd":"paint","dabs":[]})", "paint needs a layer or a tint"},
        {R"({"cmd":"paint","dabs":[],"layer":1})", "paint: \"layer\" must be a text, found number"},
        {R"({"cmd":"paint","dabs":[],"tint":[1,2]})", "paint: \"tint\" must be [red, green, blue]"},
        {R"({"cmd":"paint","dabs":[],"tint":[1,2,0]})", "tint is 2, must be 0 … 1"},
        {R"({"cmd":"paint","dabs":[],"layer":"a","noise":1.5})", "noise is 1.5, must be 0 … 1"},
        {R"({"cmd":"fill"})", "fill needs a layer or a tint"},
        {R"({"cmd":"fill","layer":"a","rect":[0,0,0,5]})",
         "fill: \"rect\" must be [x0, y0, x1, y1] with x0 < x1 and y0 < y1"},
        {R"({"cmd":"fill","layer":"a","rect":[0,0,5]})", "fill: \"rect\" must be [x0, y0, x1, y1]"},
        {R"({"cmd":"fill","layer":"a","dabs":[[1,2]]})", "fill: unknown key \"dabs\""},
        {R"({"cmd":"paint","dabs":[],"layer":"a","seed":-1})",
         "paint: \"seed\" is -1, must be 0 … 4294967295"},
        {R"({"cmd":"paint","dabs":[],"layer":"a","seed":1.5})",
         "paint: \"seed\" must be a whole number, found 1.5"},
        {R"({"cmd":"crater","x":1})", "crater: \"y\" is missing"},
        {R"({"cmd":"crater","x":1,"y":1,"radius_m":5000})", "radius_m is 5000, must be 0.1 … 2000"},
        {R"({"cmd":"crater","x":1,"y":1,"heat":1.5})", "heat is 1.5, must be 0 … 1"},
        {R"({"cmd":"crater","x":1,"y":1,"heat":"hot"})", "crater: \"heat\" must be a number, found string"},
        {R"({"cmd":"footprints","prints":[{"x":1,"y":1,"toes":5}]})",
         "footprints: print 0: unknown key \"toes\""},
        {R"({"cmd":"footprints","prints":[{"x":1,"y":1,"foot":4}]})",
         "footprints: print 0: \"foot\" is 4, must be 0 … 3"},
        {R"({"cmd":"footprints","prints":[3]})", "footprints: print 0 must be an object, found number"},
        {R"({"cmd":"operator","id":1})", "operator: \"enabled\" is missing"},
        {R"({"cmd":"operator","id":1,"enabled":1})",
         "operator: \"enabled\" must be true or false, found number"},
        {R"({"cmd":"remove","id":-4})", "remove: \"id\" is -4"},
        {R"({"cmd":"undo","group":-1})", "undo: \"group\" is -1"},
    };
    for (const auto& [json, expected] : cases) {
        const auto command = parse_command(json);
        ASSERT_FALSE(command.ok()) << json;
        EXPECT_EQ(command.message().substr(0, std::string(expected).size()), expected) << json;
        EXPECT_EQ(command.message().find('\n'), std::string::npos);
    }
    const std::string good = R"({"cmd":"paint","dabs":[[1,2]],"layer":"rock","strength":1,"tint":[0.5,1,0]})";
    for (size_t length = 0; length < good.size(); ++length)
        EXPECT_FALSE(parse_command(good.substr(0, length)).ok());
    EXPECT_FALSE(parse_command(std::string(100000, '[')).ok()) << "deep nesting";
}

TEST(brush_falloff, falls_smoothly_from_one_to_zero) {
    for (const double hardness : {0.0, 0.2, 0.5, 0.9, 1.0}) {
        EXPECT_EQ(brush_falloff(0, hardness), 1);
        EXPECT_EQ(brush_falloff(1, hardness), 0);
        EXPECT_EQ(brush_falloff(7, hardness), 0);
        EXPECT_EQ(brush_falloff(0.97 * hardness, hardness), 1) << "flat within the hard part";
        EXPECT_EQ(brush_falloff(std::nan(""), hardness), 0);
        double before = 1, slope_before = 0;
        const double step = 1e-5, steepest = 1.5 / (1 - 0.98 * hardness),
                     curvature = 6 / std::pow(1 - 0.98 * hardness, 2);
        for (double t = step; t < 1.1; t += step) {
            const double value = brush_falloff(t, hardness), slope = (value - before) / step;
            ASSERT_LE(value, before);
            ASSERT_GE(slope, -steepest - 1e-6);
            ASSERT_LE(std::abs(slope - slope_before), 1.1 * curvature * step + 1e-6) << "C1 at " << t;
            before = value;
            slope_before = slope;
        }
    }
}

// Their own command is the one that can be read again from the journal.
TEST(commands, prints_are_not_added_as_other_operators_are) {
    const Status status = check_command({AddOperatorCommand{Footprint{.x_m = 1, .y_m = 1}, {}}});
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.message(), "prints are laid by the command footprints");
}
