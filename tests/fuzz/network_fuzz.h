#pragma once

#include <array>

namespace fcn::testing {

/// One name per reader; input byte 0 of the fuzz target means 2 index + (1 with a mesh).
inline constexpr std::array<const char*, 10> kFuzzedNames{
    "n.fcn.json", "n.obj",   "n.ply", "n.vtp",           "n.mesh",
    "n.msh",      "n.sharp", "n.fl",  "n.polylines.txt", "ridges.txt"};

}  // namespace fcn::testing
