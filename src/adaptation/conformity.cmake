# Sources of the conformity checker, included by this folder's CMakeLists.txt.
set(CONFORMITY_SOURCES
    conformity.cpp
    conformity_boxes.cpp
    conformity_geodesic.cpp
    conformity_measures.cpp
    conformity_surface.cpp)
