// A box has twelve creases.
#include <iostream>

#include "features/features.h"
#include "geometry/models.h"

int main() {
    const fcn::LoadedMesh box = fcn::make_model("box");
    std::cout << fcn::detect_sharp(box).arcs.size() << " arcs\n";
}
