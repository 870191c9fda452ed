#include "ui/text_edit.h"

#include <algorithm>
#include <cctype>

#include "ui/utf8.h"

namespace loam::ui {
namespace {

constexpr size_t kHistoryLimit = 200;

// Every byte of a multibyte sequence counts as a letter.
bool is_word(char c) {
    const auto u = static_cast<unsigned char>(c);
    return u >= 0x80 || std::isalnum(u) || c == '_';
}

}  // namespace

void TextEdit::set_text(std::string_view text) {
    column_ = std::string::npos;
    text_ = text;
    caret_ = anchor_ = text_.size();
    undo_.clear();
    redo_.clear();
    last_ = Kind::none;
}

std::string_view TextEdit::selected() const {
    return std::string_view(text_).substr(selection_begin(), selection_end() - selection_begin());
}

size_t TextEdit::before(size_t at, Step step) const {
    if (step == Step::all) return 0;
    if (step == Step::line) return line_begin(at);
    if (step == Step::codepoint) return previous_codepoint(text_, at);
    while (at > 0 && !is_word(text_[at - 1])) --at;
    while (at > 0 && is_word(text_[at - 1])) --at;
    return at;
}

size_t TextEdit::after(size_t at, Step step) const {
    if (step == Step::all) return text_.size();
    if (step == Step::line) return line_end(at);
    if (step == Step::codepoint) return next_codepoint(text_, at);
    while (at < text_.size() && is_word(text_[at])) ++at;
    while (at < text_.size() && !is_word(text_[at])) ++at;
    return at;
}

size_t TextEdit::line_begin(size_t byte) const {
    const size_t found = byte == 0 ? std::string::npos : text_.rfind('\n', byte - 1);
    return found == std::string::npos ? 0 : found + 1;
}

size_t TextEdit::line_end(size_t byte) const {
    return std::min(text_.find('\n', byte), text_.size());
}

void TextEdit::move_lines(int lines, Select select) {
    size_t begin = line_begin(caret_), column = 0;
    for (size_t at = begin; at < caret_; at = next_codepoint(text_, at)) ++column;
    if (column_ != std::string::npos) column = column_;
    last_ = Kind::none;
    for (; lines < 0 && begin > 0; ++lines) begin = line_begin(begin - 1);
    for (; lines > 0 && line_end(begin) < text_.size(); --lines) begin = line_end(begin) + 1;
    const size_t end = line_end(begin);
    caret_ = begin;
    for (size_t i = 0; i < column && caret_ < end; ++i) caret_ = next_codepoint(text_, caret_);
    column_ = column;
    if (select == Select::no) anchor_ = caret_;
}

void TextEdit::move_back(Step step, Select select) {
    column_ = std::string::npos;
    last_ = Kind::none;
    const bool collapse = select == Select::no && has_selection() && step == Step::codepoint;
    caret_ = collapse ? selection_begin() : before(caret_, step);
    if (select == Select::no) anchor_ = caret_;
}

void TextEdit::move_on(Step step, Select select) {
    column_ = std::string::npos;
    last_ = Kind::none;
    const bool collapse = select == Select::no && has_selection() && step == Step::codepoint;
    caret_ = collapse ? selection_end() : after(caret_, step);
    if (select == Select::no) anchor_ = caret_;
}

void TextEdit::place(size_t byte, Select select) {
    column_ = std::string::npos;
    last_ = Kind::none;
    size_t at = 0;
    while (at < text_.size() && next_codepoint(text_, at) <= byte) at = next_codepoint(text_, at);
    caret_ = at;
    if (select == Select::no) anchor_ = caret_;
}

void TextEdit::select_all() {
    anchor_ = 0;
    caret_ = text_.size();
    last_ = Kind::none;
}

void TextEdit::select_word(size_t byte) {
    place(byte, Select::no);
    while (anchor_ > 0 && is_word(text_[anchor_ - 1])) --anchor_;
    while (caret_ < text_.size() && is_word(text_[caret_])) ++caret_;
}

void TextEdit::remember(Kind kind) {
    redo_.clear();
    if (kind == Kind::typing && last_ == Kind::typing) return;
    last_ = kind;
    undo_.push_back({text_, caret_});
    if (undo_.size() > kHistoryLimit) undo_.erase(undo_.begin());
}

void TextEdit::replace(size_t begin, size_t end, std::string_view with) {
    column_ = std::string::npos;
    text_.replace(begin, end - begin, with);
    caret_ = anchor_ = begin + with.size();
}

void TextEdit::insert(std::string_view utf8) {
    // Only well-formed text gets in: malformed bytes become U+FFFD here.
    std::string clean;
    const size_t room = max_bytes - std::min(max_bytes, text_.size() - (selection_end() - selection_begin()));
    for (size_t at = 0; at < utf8.size();) {
        const Decoded d = decode_utf8(utf8, at);
        at += d.bytes;
        const bool breaks = d.codepoint == U'\n';
        const char32_t c = (breaks && !many_lines) || d.codepoint == U'\t' ? U' ' : d.codepoint;
        if ((c < 0x20 && !(breaks && many_lines)) || c == 0x7F) continue;
        std::string one;
        append_utf8(one, c);
        if (many_lines && d.codepoint == U'\t') one = "    ";
        if (clean.size() + one.size() > room) break;
        clean += one;
    }
    if (clean.empty()) return;
    remember(has_selection() || utf8.size() > 4 ? Kind::other : Kind::typing);
    replace(selection_begin(), selection_end(), clean);
}

void TextEdit::insert_line_break() {
    const size_t begin = line_begin(selection_begin());
    size_t end = begin;
    while (end < selection_begin() && text_[end] == ' ') ++end;
    std::string line(1, '\n');
    line.append(text_, begin, end - begin);
    insert(line);
}

void TextEdit::erase_back(Step step) {
    const size_t begin = has_selection() ? selection_begin() : before(caret_, step);
    const size_t end = selection_end();
    if (begin == end) return;
    remember(Kind::other);
    replace(begin, end, {});
}

void TextEdit::erase_on(Step step) {
    const size_t begin = selection_begin();
    const size_t end = has_selection() ? selection_end() : after(caret_, step);
    if (begin == end) return;
    remember(Kind::other);
    replace(begin, end, {});
}

bool TextEdit::undo() {
    if (undo_.empty()) return false;
    redo_.push_back({text_, caret_});
    column_ = std::string::npos;
    text_ = undo_.back().text;
    caret_ = anchor_ = undo_.back().caret;
    undo_.pop_back();
    last_ = Kind::none;
    return true;
}

bool TextEdit::redo() {
    if (redo_.empty()) return false;
    undo_.push_back({text_, caret_});
    column_ = std::string::npos;
    text_ = redo_.back().text;
    caret_ = anchor_ = redo_.back().caret;
    redo_.pop_back();
    last_ = Kind::none;
    return true;
}

}  // namespace loam::ui
