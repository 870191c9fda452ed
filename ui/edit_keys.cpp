#include "ui/edit_keys.h"

namespace loam::ui {

namespace {

void copy_selection(Ui& ui, const TextEdit& edit) {
    if (edit.has_selection() && ui.clipboard.set) ui.clipboard.set(ui.clipboard.user, edit.selected());
}

// True when the key moved through lines.
bool move_through_lines(const Event& e, TextEdit& edit, Select select, int lines_a_page) {
    switch (e.key) {
        case Key::up:
            edit.move_lines(-1, select);
            return true;
        case Key::down:
            edit.move_lines(1, select);
            return true;
        case Key::page_up:
            edit.move_lines(-lines_a_page, select);
            return true;
        case Key::page_down:
            edit.move_lines(lines_a_page, select);
            return true;
        case Key::enter:
            edit.insert_line_break();
            return true;
        case Key::tab:
            if (e.mods.shift || e.mods.ctrl) return false;  // moves the focus
            edit.insert("\t");
            return true;
        default:
            return false;
    }
}

}  // namespace

EditKey apply_edit_key(Ui& ui, const Event& e, TextEdit& edit, int lines_a_page) {
    const Select select = e.mods.shift ? Select::yes : Select::no;
    const Step step = e.mods.ctrl ? Step::word : Step::codepoint;
    const Step to_end = edit.many_lines && !e.mods.ctrl ? Step::line : Step::all;
    if (e.mods.alt || e.mods.super) return EditKey::not_ours;
    if (edit.many_lines && move_through_lines(e, edit, select, lines_a_page)) return EditKey::used;
    switch (e.key) {
        case Key::left:
            edit.move_back(step, select);
            return EditKey::used;
        case Key::right:
            edit.move_on(step, select);
            return EditKey::used;
        case Key::home:
        case Key::up:
            edit.move_back(to_end, select);
            return EditKey::used;
        case Key::end:
        case Key::down:
            edit.move_on(to_end, select);
            return EditKey::used;
        case Key::backspace:
            edit.erase_back(step);
            return EditKey::used;
        case Key::del:
            edit.erase_on(step);
            return EditKey::used;
        case Key::enter:
            return EditKey::accepted;
        case Key::escape:
            return EditKey::cancelled;
        case Key::tab:
            return EditKey::not_ours;
        default:
            break;
    }
    // Its character follows as a text event.
    if (!e.mods.ctrl) return e.key < Key::f1 || e.key > Key::f12 ? EditKey::used : EditKey::not_ours;
    switch (e.key) {
        case Key::a:
            edit.select_all();
            return EditKey::used;
        case Key::c:
            copy_selection(ui, edit);
            return EditKey::used;
        case Key::x:
            copy_selection(ui, edit);
            if (edit.has_selection()) edit.erase_back(Step::codepoint);
            return EditKey::used;
        case Key::v:
            if (ui.clipboard.get) edit.insert(ui.clipboard.get(ui.clipboard.user));
            return EditKey::used;
        case Key::z:
            e.mods.shift ? edit.redo() : edit.undo();
            return EditKey::used;
        case Key::y:
            edit.redo();
            return EditKey::used;
        default:
            return EditKey::not_ours;
    }
}

}  // namespace loam::ui
