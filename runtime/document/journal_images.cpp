#include "runtime/document/journal_images.h"

#include "runtime/document/byte_stream.h"
#include "runtime/document/operator_json.h"
#include "runtime/document/operator_nodes.h"
#include "runtime/document/transitions.h"

namespace loam {

namespace {

Status swap_page(PageStore& store, RowImage& image, PageBalance& balance) {
    auto current = store.read_page(image.key);
    if (!current.ok()) return current.error();
    if (image.bytes)
        LOAM_TRY(store.write_page(image.key, *image.bytes));
    else
        LOAM_TRY(store.erase_page(image.key));
    int64_t& count = PageKey::unpacked(image.key).map == BaseMap::height ? balance.height : balance.index;
    count += int64_t(image.bytes.has_value()) - int64_t(current->has_value());
    image.bytes = std::move(*current);
    return {};
}

Status swap_operator(PageStore& store, RowImage& image, const OperatorGrids& grids) {
    const uint64_t id = uint64_t(image.key);
    auto current = store.read_operator(id);
    if (!current.ok()) return current.error();
    if (image.bytes) {
        const std::string_view json(reinterpret_cast<const char*>(image.bytes->data()), image.bytes->size());
        const auto op = parse_operator(id, json);
        if (!op.ok()) return error("the journal: {}", op.message());
        LOAM_TRY(store.write_operator(id, json, node_of(*op, grids)));
    } else {
        LOAM_TRY(store.erase_operator(id));
    }
    image.bytes.reset();
    if (current->has_value()) image.bytes.emplace((*current)->json.begin(), (*current)->json.end());
    return {};
}

Status swap_transition(SettingsEdit& settings, RowImage& image) {
    if (!settings.changed) settings.changed = settings.current;
    std::vector<LayerEntry>& layers = settings.changed->layers;
    const size_t place = size_t(image.key);
    if (image.key < 0 || place > layers.size() || (place < layers.size() && !layers[place].blend))
        return error("the journal tells of a transition at place {} of the layer list, which is none",
                     image.key);
    std::optional<std::vector<uint8_t>> before;
    if (place < layers.size()) {
        const std::string text = transition_json(layers[place]);
        before.emplace(text.begin(), text.end());
    }
    if (image.bytes) {
        auto entry =
            parse_transition({reinterpret_cast<const char*>(image.bytes->data()), image.bytes->size()});
        if (!entry.ok()) return error("the journal: {}", entry.message());
        if (place == layers.size()) layers.emplace_back();
        layers[place] = std::move(*entry);
        if (layers[place].blend->removed) layers[place].name = name_of_removed(*settings.changed, place);
    } else if (place < layers.size() && !layers[place].blend->removed) {
        const auto removed = remove_transition(*settings.changed, layers[place].name);
        if (!removed.ok()) return removed.error();
    }
    image.bytes = std::move(before);
    return {};
}

}  // namespace

std::vector<uint8_t> image_bytes(const std::vector<RowImage>& images) {
    ByteWriter writer;
    for (const RowImage& image : images) {
        writer.u8(uint8_t(image.kind));
        writer.u64(uint64_t(image.key));
        writer.u8(image.bytes.has_value());
        writer.u32(image.bytes ? uint32_t(image.bytes->size()) : 0);
        if (image.bytes) writer.bytes(*image.bytes);
    }
    return writer.take();
}

Result<std::vector<RowImage>> images_of(std::span<const uint8_t> bytes) {
    ByteReader reader(bytes);
    std::vector<RowImage> images;
    while (reader.ok() && !reader.at_end()) {
        RowImage image;
        const uint8_t kind = reader.u8();
        image.key = int64_t(reader.u64());
        const uint8_t present = reader.u8();
        const auto content = reader.bytes(reader.u32());
        if (kind > uint8_t(RowImage::Kind::transition) || present > 1 || (present == 0 && !content.empty()))
            return error("damaged images of a command in the journal");
        image.kind = RowImage::Kind(kind);
        if (present == 1) image.bytes.emplace(content.begin(), content.end());
        images.push_back(std::move(image));
    }
    if (!reader.ok()) return error("the images of a command in the journal are cut short");
    return images;
}

Status swap_images(PageStore& store, std::vector<RowImage>& images, PageBalance& balance,
                   SettingsEdit& settings) {
    const OperatorGrids grids = grids_of(settings.current);
    for (RowImage& image : images) {
        switch (image.kind) {
            case RowImage::Kind::page:
                LOAM_TRY(swap_page(store, image, balance));
                break;
            case RowImage::Kind::op:
                LOAM_TRY(swap_operator(store, image, grids));
                break;
            case RowImage::Kind::transition:
                LOAM_TRY(swap_transition(settings, image));
                break;
        }
    }
    return {};
}

}  // namespace loam
