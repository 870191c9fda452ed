// Everything an application needs to build an interface.
#pragma once

#include "ui/controls.h"
#include "ui/dialog.h"
#include "ui/menu.h"
#include "ui/panel.h"
#include "ui/shortcuts.h"
#include "ui/slider.h"
#include "ui/text_area.h"
#include "ui/text_field.h"
#include "ui/tiles.h"
#include "ui/ui.h"
#include "ui/viewport.h"
