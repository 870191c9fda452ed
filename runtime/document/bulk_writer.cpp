// Whole maps, row by row. For every mip a band of 64 rows is kept; a full band is cut in pages, encoded on
// all cores and written. Everything is one transaction, committed by `finish`.
#include <algorithm>
#include <optional>

#include "runtime/base/check.h"
#include "runtime/base/job_queue.h"
#include "runtime/base/units.h"
#include "runtime/document/document_impl.h"

namespace loam {

namespace {

template <typename Sample>
class MapWriter {
  public:
    MapWriter(PageStore& store, const MapShape& shape, const Sample& fallback, bool has_pages)
        : store_(store), shape_(shape), fallback_(fallback), has_pages_(has_pages) {
        for (int mip = 0; mip < shape.mip_count; ++mip)
            bands_.emplace_back(size_t(shape.width(mip)) * size_t(kBasePageSide), fallback);
    }

    Status add_row(const Sample* samples) {
        for (int mip = 0; mip < shape_.mip_count && next_row_ % (1 << mip) == 0; ++mip) {
            const int row = next_row_ >> mip, width = shape_.width(mip);
            Sample* to = bands_[size_t(mip)].data() + size_t(row % kBasePageSide) * size_t(width);
            for (int x = 0; x < width; ++x) to[x] = samples[size_t(x) << mip];
            if (row % kBasePageSide == kBasePageSide - 1 || row == shape_.height(mip) - 1)
                LOAM_TRY(write_band(mip, row));
        }
        ++next_row_;
        return {};
    }

    [[nodiscard]] int next_row() const { return next_row_; }
    [[nodiscard]] const MapShape& shape() const { return shape_; }
    [[nodiscard]] int64_t gained() const { return gained_; }

  private:
    Status write_band(int mip, int last_row) {
        const int width = shape_.width(mip), pages_x = shape_.pages_x(mip),
                  rows = last_row % kBasePageSide + 1;
        const Sample* band = bands_[size_t(mip)].data();
        std::vector<std::optional<std::vector<uint8_t>>> blobs{size_t(pages_x)};
        parallel_ranges(pages_x, 8, [&](int begin, int end) {
            for (int page_x = begin; page_x < end; ++page_x) {
                BasePage<Sample> page;
                page.fill(fallback_);
                const int columns = std::min(kBasePageSide, width - page_x * kBasePageSide);
                for (int y = 0; y < rows; ++y)
                    std::copy_n(band + size_t(y) * size_t(width) + size_t(page_x) * kBasePageSide, columns,
                                page.begin() + y * kBasePageSide);
                if (!std::all_of(page.begin(), page.end(), [&](const Sample& s) { return s == fallback_; }))
                    blobs[size_t(page_x)] = encode_page<Sample>(page);
            }
        });
        for (int page_x = 0; page_x < pages_x; ++page_x)
            LOAM_TRY(write_page(PageKey{shape_.map, mip, page_x, last_row / kBasePageSide}.packed(),
                                blobs[size_t(page_x)]));
        return {};
    }

    Status write_page(int64_t key, const std::optional<std::vector<uint8_t>>& blob) {
        bool had = false;
        if (has_pages_) {
            const auto before = store_.read_page(key);
            if (!before.ok()) return before.error();
            had = before->has_value();
        }
        gained_ += int64_t(blob.has_value()) - int64_t(had);
        if (blob) return store_.write_page(key, *blob);
        return had ? store_.erase_page(key) : Status();
    }

    PageStore& store_;
    const MapShape shape_;
    const Sample fallback_;
    const bool has_pages_;  // of this map, before
    std::vector<std::vector<Sample>> bands_;
    int next_row_ = 0;
    int64_t gained_ = 0;
};

}  // namespace

struct BulkWriter::Impl {
    Document::Impl& document;
    std::optional<MapWriter<int32_t>> heights;
    std::optional<MapWriter<IndexTexel>> texels;
    bool open = false;    // the transaction is ours
    bool broken = false;  // an error came back: nothing more is taken

    Status begin() {
        if (broken) return error("the bulk write has failed before; nothing of it was kept");
        if (open) return {};
        LOAM_TRY(document.may_write());
        LOAM_TRY(check_journal());
        LOAM_TRY(document.store.begin());
        open = document.bulk_writing = true;
        return {};
    }

    // What changed operators or the layer list can be undone whatever the maps are.
    Status check_journal() {
        bool edited = false;
        const Status read = document.store.for_each_journal(
            0, PageStore::JournalColumns::all, [&](const JournalRow& row) -> Status {
                const auto images = images_of(row.images);
                if (!images.ok()) return images.error();
                edited = std::any_of(images->begin(), images->end(), [](const RowImage& image) {
                    return image.kind == RowImage::Kind::page;
                });
                return edited ? error("an edit of a map") : Status();  // the first is enough
            });
        if (edited)
            return error(
                "the journal holds edits of the maps that could not be undone after a bulk write; "
                "import into a new project");
        return read;
    }

    void abandon() {
        if (open) document.store.rollback();
        if (open) document.bulk_writing = false;
        open = false;
        heights.reset();
        texels.reset();
    }

    Status fail(const Status& status) {
        abandon();
        broken = true;
        return status;
    }

    template <typename Sample>
    Status add_rows(MapWriter<Sample>& writer, const char* map, int first_row, int row_count,
                    std::span<const Sample> samples) {
        const MapShape& shape = writer.shape();
        if (first_row != writer.next_row())
            return fail(error("{} row {} was given, {} comes next; rows go from south to north", map,
                              first_row, writer.next_row()));
        if (row_count < 0 || row_count > shape.samples_y - first_row)
            return fail(error("{} {} rows from row {} on, the map has {}", row_count, map, first_row,
                              shape.samples_y));
        const size_t width = size_t(shape.samples_x);
        if (samples.size() != size_t(row_count) * width)
            return fail(error("{} {} samples for {} rows of {}", samples.size(), map, row_count, width));
        for (int row = 0; row < row_count; ++row) {
            const Status status = writer.add_row(samples.data() + size_t(row) * width);
            if (!status.ok()) return fail(status);
        }
        return {};
    }

    template <typename Sample>
    static Status complete(const std::optional<MapWriter<Sample>>& writer, const char* map) {
        if (!writer || writer->next_row() == writer->shape().samples_y) return {};
        return error("only {} of {} {} rows were written", writer->next_row(), writer->shape().samples_y,
                     map);
    }

    Status write_counts(const PageBalance& count) {
        LOAM_TRY(document.store.write_meta("height_pages", count.height));
        return document.store.write_meta("index_pages", count.index);
    }
};

BulkWriter::BulkWriter(Document& document)
    : impl_(new Impl{.document = *document.impl_, .heights = {}, .texels = {}}) {}

BulkWriter::~BulkWriter() {
    impl_->abandon();
}

Status BulkWriter::write_height_rows(int first_row, int row_count, std::span<const int32_t> mm) {
    LOAM_TRY(impl_->begin());
    if (!impl_->heights)
        impl_->heights.emplace(impl_->document.store, impl_->document.height,
                               impl_->document.settings.default_height_mm,
                               impl_->document.page_count.height != 0);
    if (std::all_of(mm.begin(), mm.end(), [](int32_t v) { return v == saturate_height_mm(v); }))
        return impl_->add_rows(*impl_->heights, "height", first_row, row_count, mm);
    std::vector<int32_t> saturated(mm.size());
    std::transform(mm.begin(), mm.end(), saturated.begin(), [](int32_t v) { return saturate_height_mm(v); });
    return impl_->add_rows(*impl_->heights, "height", first_row, row_count,
                           std::span<const int32_t>(saturated));
}

Status BulkWriter::write_index_rows(int first_row, int row_count, std::span<const IndexTexel> texels) {
    LOAM_TRY(impl_->begin());
    if (!impl_->texels)
        impl_->texels.emplace(impl_->document.store, impl_->document.index,
                              default_texel(impl_->document.settings), impl_->document.page_count.index != 0);
    if (!std::all_of(texels.begin(), texels.end(), [](const IndexTexel& t) { return t.unused == 0; }))
        return impl_->fail(error("the unused byte of an index texel must be 0"));
    return impl_->add_rows(*impl_->texels, "index", first_row, row_count, texels);
}

Status BulkWriter::finish() {
    LOAM_TRY(impl_->begin());
    for (const Status& status :
         {Impl::complete(impl_->heights, "height"), Impl::complete(impl_->texels, "index")})
        if (!status.ok()) return impl_->fail(status);
    Document::Impl& document = impl_->document;
    PageBalance count = document.page_count;
    if (impl_->heights) count.height += impl_->heights->gained();
    if (impl_->texels) count.index += impl_->texels->gained();
    Status status = impl_->write_counts(count);
    if (!status.ok()) return impl_->fail(status);
    {
        const Document::Impl::Exclusive exclusive(document);
        status = document.store.commit();
        if (!status.ok()) return impl_->fail(status);
        document.pages->clear();
        document.page_count = count;
        ++document.revision;
        document.bulk_writing = impl_->open = false;
    }
    impl_->abandon();
    // Readers may hold the WAL; then it is emptied later.
    (void)document.store.checkpoint();
    return {};
}

}  // namespace loam
