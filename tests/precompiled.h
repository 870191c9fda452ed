// The tests' counterpart of runtime/base/precompiled.h.
#pragma once

#include "runtime/base/precompiled.h"

#include <random>

#include <gtest/gtest.h>
