// A small project on disk with rough ground, and random commands on it.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "decal_fixture.h"
#include "runtime/document/document.h"
#include "runtime/maps/virtual_map.h"

namespace loam::test {

struct MapFixtureDesc {
    int samples_x = 300, samples_y = 260;
    double height_spacing_m = 1.0;
    int refine = 2;
    double index_spacing_m = 0.5;
    double relief_m = 20;
    int layers = 3;  // beyond grass, dirt and scree: "layer 3" and so on
    GroundSettings ground;
    std::vector<LayerEntry> transitions;  // after the layers
    std::vector<Channel> channels;  // with any, the layers have amounts of all of them
};

class MapFixture {
  public:
    explicit MapFixture(const MapFixtureDesc& desc, uint32_t seed = 1) : random_(seed) {
        static int count = 0;
        folder_ = std::filesystem::temp_directory_path() /
                  ("loam-maps-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
        ProjectSettings settings;
        settings.name = "maps";
        settings.height_samples_x = desc.samples_x;
        settings.height_samples_y = desc.samples_y;
        settings.height_spacing_m = desc.height_spacing_m;
        settings.refine = desc.refine;
        settings.index_spacing_m = desc.index_spacing_m;
        settings.layers = {
            {"grass", "layers/grass.layer"}, {"dirt", "layers/dirt.layer"}, {"scree", "layers/scree.layer"}};
        for (int i = 3; i < desc.layers; ++i) {
            const std::string name = "layer " + std::to_string(i);
            settings.layers.push_back({name, "layers/" + name + ".layer"});
        }
        settings.layers.insert(settings.layers.end(), desc.transitions.begin(), desc.transitions.end());
        settings.ground = desc.ground;
        settings.channels = desc.channels;
        if (!desc.channels.empty()) {
            settings.layers[0].channels = {0.6, 0.2, 0.3, 0.5};
            settings.layers[1].channels = {0.1, 0.5, 0.8, 0.2};
            settings.layers[2].channels = {0.9, 0.3, 0.1, 0.9};
        }
        auto created = Document::create(folder_, settings);
        if (!created) {
            ADD_FAILURE() << created.message();
            return;
        }
        document_ = std::move(*created);
        write_ground(desc);
    }
    ~MapFixture() {
        document_.reset();
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    MapFixture(const MapFixture&) = delete;

    Document& document() { return *document_; }
    int uniform(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
    double real(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    glm::dvec2 place() {  // on the map and a little beyond
        const WorldRect b = document_->bounds();
        return {real(b.min_x - 3, b.max_x + 3), real(b.min_y - 3, b.max_y + 3)};
    }
    MapPage page(const VirtualMap& map) {
        const int level = uniform(0, map.root().level);
        return {level, uniform(0, map.pages_x(level) - 1), uniform(0, map.pages_y(level) - 1)};
    }
    TexelRect rect(int texels) {
        const int x0 = uniform(0, texels - 1), y0 = uniform(0, texels - 1);
        return {x0, y0, uniform(x0 + 1, texels), uniform(y0 + 1, texels)};
    }

    Dirt apply(CommandBody body) {
        auto dirt = document_->apply({std::move(body)});
        if (!dirt) {
            ADD_FAILURE() << dirt.message();
            return {};
        }
        return *dirt;
    }
    Dirt crater(double x, double y, double radius) {
        Crater crater;
        crater.x_m = x;
        crater.y_m = y;
        crater.radius_m = radius;
        crater.seed = uint32_t(random_());
        return apply(CraterCommand{crater});
    }
    Dirt cutout() {
        return apply(AddOperatorCommand{random_cutout(random_, place(), real(-20, 20), real(2, 30))});
    }
    Dirt time(double time_s) { return apply(TimeCommand{time_s}); }
    Dirt random_command() {
        const glm::dvec2 at = place();
        switch (uniform(0, 14)) {
            case 0:
                return crater(at.x, at.y, real(0.5, 25));
            case 1: {
                FootprintsCommand prints;
                for (int i = uniform(1, 4); i > 0; --i) {
                    Footprint print;
                    print.x_m = at.x + i;
                    print.y_m = at.y;
                    print.heading_rad = real(0, 6);
                    print.length_m = real(0.3, 3);
                    print.foot = uniform(0, kFurrow);
                    prints.prints.push_back(print);
                }
                return apply(prints);
            }
            case 2:
                if (document_->can_undo()) return apply(UndoCommand{});
                break;
            case 3:
                if (document_->can_redo()) return apply(RedoCommand{});
                break;
            case 4: {
                const auto operators = document_->operators();
                if (operators.empty()) break;
                const Operator& op = operators[size_t(uniform(0, int(operators.size()) - 1))];
                if (uniform(0, 1)) return apply(RemoveOperatorCommand{op.id});
                return apply(SetOperatorCommand{op.id, !op.enabled});
            }
            case 5: {
                PaintCommand paint;
                paint.dabs = {at, at + glm::dvec2(2, 1)};
                paint.radius_m = real(0.5, 12);
                paint.layer = uniform(0, 1) ? "scree" : "dirt";
                paint.tint = glm::dvec3(real(0, 1), 0.5, 0.25);
                paint.strength = 0.7;
                paint.seed = uint32_t(random_());
                return apply(paint);
            }
            case 6:
                return apply(
                    AddOperatorCommand{random_decal(random_, at, real(0.5, 20)), random_life(random_)});
            case 7: {
                const auto operators = document_->operators();
                if (operators.empty()) break;
                const uint64_t id = operators[size_t(uniform(0, int(operators.size()) - 1))].id;
                if (uniform(0, 1)) return apply(ReorderCommand{id, uint64_t(uniform(0, 40))});
                return apply(EditOperatorCommand{id, random_decal(random_, at, real(0.5, 20))});
            }
            case 8:
                return cutout();
            case 9:
                return apply(AddOperatorCommand{random_earth(random_, at, real(-20, 20), real(2, 20)),
                                                random_life(random_)});
            case 10:
                return apply(AddOperatorCommand{random_event(random_, at, real(-20, 20), real(1, 12))});
            case 11: {
                Crater crater{.x_m = at.x, .y_m = at.y, .radius_m = real(0.5, 25), .heat = real(0, 1)};
                return apply(CraterCommand{crater, random_life(random_)});
            }
            case 12:
            case 13:
                return time(real(-5, 1.5 * kRandomTimes_s));
            default:
                break;
        }
        SculptCommand sculpt;
        sculpt.mode = SculptMode(uniform(0, 3));
        sculpt.dabs = {at, at + glm::dvec2(real(-3, 3), real(-3, 3))};
        sculpt.radius_m = real(0.3, 15);
        sculpt.strength = real(0.1, 1);
        sculpt.target_m = 3;
        return apply(sculpt);
    }

  private:
    void write_ground(const MapFixtureDesc& desc) {
        BulkWriter writer(*document_);
        std::vector<int32_t> row(size_t(desc.samples_x));
        for (int j = 0; j < desc.samples_y; ++j) {
            for (int i = 0; i < desc.samples_x; ++i) {
                const double x = i * 0.05, y = j * 0.05;
                const double hills = std::sin(x) * std::cos(y * 0.7) + 0.3 * std::sin(3.1 * x + 2.3 * y);
                const double rough = ((i * 7919 + j * 104729 + i * j * 13) % 1000) * 0.0001;
                row[size_t(i)] = int32_t((hills + rough) * desc.relief_m * 1000);
            }
            const Status status = writer.write_height_rows(j, 1, row);
            if (!status.ok()) ADD_FAILURE() << status.message();
        }
        const glm::ivec2 size = document_->index_size_texels();
        std::vector<IndexTexel> texels(size_t(size.x));
        for (int j = 0; j < size.y; ++j) {
            for (int i = 0; i < size.x; ++i)
                texels[size_t(i)] = {
                    uint16_t((i / 5 + j / 7) % 3), {uint8_t(i), uint8_t(j), uint8_t(i * j)}, 0};
            const Status status = writer.write_index_rows(j, 1, texels);
            if (!status.ok()) ADD_FAILURE() << status.message();
        }
        const Status status = writer.finish();
        if (!status.ok()) ADD_FAILURE() << status.message();
    }

    std::mt19937 random_;
    std::filesystem::path folder_;
    std::unique_ptr<Document> document_;
};

}  // namespace loam::test
