#pragma once

#include <array>
#include <string>

#include "geometry/surface_queries.h"
#include "report/camera.h"
#include "report/picture.h"
#include "report/report.h"

namespace fcn {

/// Colours of the report's pictures and their legends, after Okabe and Ito: told apart with any
/// kind of colour vision. The same in viewer/src/palette.js.
struct ReportPalette {
    Color initial{82, 92, 106};
    Color kept{0, 100, 176};
    Color dropped{213, 94, 0};
    Color pinned{0, 130, 95};
    Color brief{204, 121, 167};      ///< short arcs, while a network is adapted
    Color fewer_quads{200, 30, 60};  ///< irregular vertices, index above 0
    Color more_quads{40, 60, 200};   ///< index below 0
    Color single{150, 156, 164};     ///< arcs without symmetric partners
    std::array<Color, 8> orbits{Color{176, 24, 44},  Color{38, 70, 122},  Color{232, 128, 8},
                                Color{22, 130, 72},  Color{128, 62, 150}, Color{0, 140, 160},
                                Color{150, 100, 40}, Color{214, 60, 140}};
};

std::string css_color(const Color& color);

/// The pictures of one mesh, all from the same side.
class ReportPictures {
public:
    explicit ReportPictures(const MeshRecord& record, int width = 840, int height = 640);

    /// The mesh with its initial network; pinned arcs in their own colour.
    std::string initial() const;
    /// The arcs of the initial network's symmetry orbits, a colour of the palette each in turn; the
    /// other arcs grey.
    std::string orbits() const;
    /// The initial network with what was dropped at this scale in another colour.
    std::string fate(const ScaleRecord& scale) const;
    /// The adapted network: segments as the straight pieces they are, laid onto the surface.
    std::string adapted(const ScaleRecord& scale) const;
    /// The remeshed surface with its edges and the adapted network.
    std::string remesh(const ScaleRecord& scale) const;
    /// The quads of this scale, which has some, with their edges, the adapted network, and a dot on
    /// each irregular vertex.
    std::string quads(const ScaleRecord& scale) const;

private:
    PictureOptions options(bool is_wireframe = false) const;

    const MeshRecord& record_;
    int width_ = 0, height_ = 0;  ///< pixels
    CameraFrame camera_;
    SurfaceQueries surface_;
};

}  // namespace fcn
