// Keys of text that is being edited, for fields and areas alike.
#pragma once

#include "ui/text_edit.h"
#include "ui/ui.h"

namespace loam::ui {

enum class EditKey { not_ours, used, accepted, cancelled };  // of one line Enter accepts; Escape cancels

[[nodiscard]] EditKey apply_edit_key(Ui& ui, const Event& event, TextEdit& edit, int lines_a_page = 1);

}  // namespace loam::ui
