// What the document's tests share: a folder that goes away, a small project, random commands.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <random>
#include <string>

#include <unistd.h>

#include <gtest/gtest.h>

#include "decal_fixture.h"
#include "runtime/document/document.h"

namespace loam::test {

class TemporaryFolder {
  public:
    TemporaryFolder() {
        static std::atomic<int> counter{0};
        path_ = std::filesystem::temp_directory_path() /
                ("loam_test_" + std::to_string(getpid()) + "_" + std::to_string(counter++));
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

// Odd sizes on purpose: pages are cut at the edges. Three layers.
inline ProjectSettings small_settings() {
    ProjectSettings settings;
    settings.name = "small";
    settings.height_samples_x = 301;
    settings.height_samples_y = 207;
    settings.height_spacing_m = 1.0;
    settings.index_spacing_m = 0.5;
    settings.default_height_mm = 12000;
    settings.layers = {{"grass", "layers/grass.layer", 2.0},
                       {"dirt", "layers/dirt.layer", 1.5},
                       {"scree", "layers/scree.layer", 3.0}};
    return settings;
}

template <typename T>
T take(Result<T> result) {
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.message());
    return std::move(result).value();
}

inline std::unique_ptr<Document> create_small(const std::filesystem::path& folder) {
    return take(Document::create(folder, small_settings()));
}

// Any command but undo and redo; `id`s are of operators that may or may not exist.
inline Command random_command(std::mt19937& random, uint64_t most_id) {
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto whole = [&](int low, int high) {
        return std::uniform_int_distribution<int>(low, high)(random);
    };
    const auto place = [&] { return glm::dvec2(uniform(-20, 320), uniform(-20, 230)); };
    const auto dabs = [&] {
        std::vector<glm::dvec2> list(size_t(whole(1, 4)));
        for (auto& dab : list) dab = place();
        return list;
    };
    Command command;
    switch (whole(0, 16)) {
        case 0:
        case 1:
        case 2: {
            SculptCommand sculpt{.mode = SculptMode(whole(0, 3)), .dabs = dabs()};
            sculpt.radius_m = uniform(0.1, 40);
            sculpt.strength = uniform(0, 1);
            sculpt.hardness = uniform(0, 1);
            sculpt.target_m = uniform(-20, 30);
            command.body = sculpt;
            break;
        }
        case 3:
        case 4:
        case 5: {
            PaintCommand paint;
            paint.dabs = dabs();
            paint.radius_m = uniform(0.1, 20);
            const char* names[] = {"grass", "dirt", "scree"};
            if (whole(0, 2) != 0) paint.layer = names[whole(0, 2)];
            if (!paint.layer || whole(0, 1) != 0)
                paint.tint = glm::dvec3(uniform(0, 1), uniform(0, 1), uniform(0, 1));
            paint.strength = uniform(0, 1);
            paint.hardness = uniform(0, 1);
            if (whole(0, 1) != 0) paint.mask.max_slope_rad = uniform(0, 1);
            if (whole(0, 3) == 0) paint.mask.min_height_m = uniform(0, 20);
            if (whole(0, 3) == 0) paint.mask = {.noise = uniform(0, 1), .noise_size_m = uniform(0.5, 50)};
            paint.seed = uint32_t(random());
            command.body = paint;
            if (whole(0, 3) != 0) break;
            const glm::dvec2 from = place();
            FillCommand fill{
                .rect = WorldRect{from.x, from.y, from.x + uniform(1, 80), from.y + uniform(1, 80)},
                .layer = paint.layer,
                .tint = paint.tint,
                .replace = {},
                .strength = paint.strength,
                .mask = paint.mask,
                .seed = paint.seed};
            if (whole(0, 1) != 0) fill.replace = names[whole(0, 2)];
            if (whole(0, 3) == 0) fill.rect.reset();
            command.body = fill;
            break;
        }
        case 6: {
            const glm::dvec2 center = place();
            command.body =
                CraterCommand{{center.x, center.y, uniform(0.5, 30), uniform(0, 5), uint32_t(random())}};
            break;
        }
        case 7: {
            FootprintsCommand prints;
            for (int i = whole(1, 5); i > 0; --i) {
                const glm::dvec2 at = place();
                prints.prints.push_back({at.x, at.y, uniform(-3, 3), uniform(0.1, 0.5), uniform(0, 0.1),
                                         i % 2, uint32_t(random())});
            }
            command.body = prints;
            break;
        }
        case 8:
            command.body = SetOperatorCommand{random() % (most_id + 1), whole(0, 1) == 1};
            break;
        case 9:
            command.body =
                AddOperatorCommand{random_decal(random, place(), uniform(0.5, 20)), random_life(random)};
            break;
        case 10:
            command.body = EditOperatorCommand{random() % (most_id + 1),
                                               random_decal(random, place(), uniform(0.5, 20))};
            break;
        case 11:
            command.body = ReorderCommand{random() % (most_id + 1), uint64_t(whole(0, 40))};
            break;
        case 12: {
            TransitionCommand transition{
                .name = "edge " + std::to_string(whole(0, 2)), .from = {}, .to = {}, .threshold = {}};
            if (whole(0, 3) == 0) {
                transition.remove = true;
            } else {
                transition.from = "grass";
                transition.to = whole(0, 1) ? "dirt" : "scree";
                if (whole(0, 1)) transition.threshold = uniform(0, 1);
            }
            command.body = transition;
            break;
        }
        case 13:
            command.body =
                AddOperatorCommand{random_earth(random, place(), 5, uniform(1, 20)), random_life(random)};
            break;
        case 14:
            command.body = AddOperatorCommand{random_event(random, place(), 5, uniform(1, 20))};
            break;
        case 15:
            command.body = TimeCommand{uniform(-10, 1.5 * kRandomTimes_s)};
            break;
        default:
            command.body = RemoveOperatorCommand{random() % (most_id + 1)};
            break;
    }
    return command;
}

}  // namespace loam::test
