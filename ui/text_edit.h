// Editing one line of text: the model of text fields, without drawing. Offsets are bytes and always on code
// points.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace loam::ui {

enum class Step { codepoint, word, all };
enum class Select { no, yes };  // whether a movement extends the selection

class TextEdit {
  public:
    void set_text(std::string_view text);  // forgets history; caret at the end
    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] size_t caret() const { return caret_; }
    [[nodiscard]] size_t selection_begin() const { return caret_ < anchor_ ? caret_ : anchor_; }
    [[nodiscard]] size_t selection_end() const { return caret_ < anchor_ ? anchor_ : caret_; }
    [[nodiscard]] bool has_selection() const { return caret_ != anchor_; }
    [[nodiscard]] std::string_view selected() const;

    void move_back(Step step, Select select);
    void move_on(Step step, Select select);
    void place(size_t byte, Select select);  // snapped back to a code point
    void select_all();
    void select_word(size_t byte);

    void insert(
        std::string_view utf8);  // replaces the selection; line breaks become spaces, controls are dropped
    void erase_back(Step step);
    void erase_on(Step step);
    bool undo();
    bool redo();

    size_t max_bytes = 4096;

  private:
    struct Snapshot {
        std::string text;
        size_t caret;
    };
    enum class Kind { none, typing, other };
    void remember(Kind kind);  // runs of typing are one step
    void replace(size_t begin, size_t end, std::string_view with);
    [[nodiscard]] size_t before(size_t at, Step step) const;
    [[nodiscard]] size_t after(size_t at, Step step) const;

    std::string text_{};
    size_t caret_ = 0, anchor_ = 0;
    std::vector<Snapshot> undo_, redo_;
    Kind last_ = Kind::none;
};

}  // namespace loam::ui
