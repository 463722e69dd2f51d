// The states of joints that follow the paper's law.
#pragma once
#include "JointLaw.hpp"
#include "SideBySide.hpp"
#include "law/ColumnsWith.hpp"

namespace masonry {

using JointColumns = ColumnsWith<JointLaw>;

} // namespace masonry
