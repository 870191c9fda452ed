// Editing text, one line or many: the model of text fields and areas, without drawing. Offsets are bytes and
// always on code points.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace loam::ui {

enum class Step { codepoint, word, line, all };  // line: to its end
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
    void move_lines(int lines, Select select);  // up is negative; the column stays where it can
    void select_all();
    void select_word(size_t byte);

    // Replaces the selection; controls are dropped, tabs become spaces, and so do line breaks but in many
    // lines.
    void insert(std::string_view utf8);
    void insert_line_break();  // the new line begins as far in as this one
    void erase_back(Step step);
    void erase_on(Step step);
    bool undo();
    bool redo();

    [[nodiscard]] size_t line_begin(size_t byte) const;
    [[nodiscard]] size_t line_end(size_t byte) const;

    size_t max_bytes = 4096;
    bool many_lines = false;

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
    size_t column_ = std::string::npos;  // that move_lines aims at; npos: the caret's
    std::vector<Snapshot> undo_, redo_;
    Kind last_ = Kind::none;
};

}  // namespace loam::ui
