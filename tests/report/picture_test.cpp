#include "report/picture.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <limits>

#include "decoded_picture.h"
#include "geometry/errors.h"
#include "report/camera.h"

namespace fcn {
namespace {

using test::decode_png;
using test::DecodedPicture;

const Color kRed{220, 0, 0};

/// Unit square in the plane z = height, n x n cells, facing +z.
Mesh square(double height, int n = 4) {
    Mesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            mesh.add_vertex({static_cast<double>(i) / n, static_cast<double>(j) / n, height});
    const auto at = [&](int i, int j) { return mesh.vertex_handle(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            mesh.add_face(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.add_face(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return mesh;
}

Mesh box() {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) mesh.add_vertex(Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1));
    const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& q : quads) {
        const auto v = [&](int k) { return mesh.vertex_handle(q[k]); };
        mesh.add_face(v(0), v(1), v(2));
        mesh.add_face(v(0), v(2), v(3));
    }
    return mesh;
}

PictureLayer line(const Vec3& from, const Vec3& to, double width = 3) {
    return {{{from, to}}, kRed, width};
}

PictureOptions from_above(int width = 200, int height = 200) {
    PictureOptions options;
    options.width = width;
    options.height = height;
    options.view = Vec3::UnitZ();
    options.up = Vec3::UnitY();
    return options;
}

TEST(Picture, IsAPngOfTheSizeAskedFor) {
    const DecodedPicture picture = decode_png(render_png(box(), {}, from_above(123, 45)));
    EXPECT_EQ(picture.width, 123);
    EXPECT_EQ(picture.height, 45);
}

TEST(Picture, SameInputGivesSameBytesOnAnyNumberOfThreads) {
    const std::vector<PictureLayer> layers{line({0, 0, 1}, {1, 1, 1})};
    PictureOptions options;
    options.is_drawing_wireframe = true;
    std::string one, many;
    {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
        one = render_png(box(), layers, options);
    }
    {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 4);
        many = render_png(box(), layers, options);
    }
    EXPECT_EQ(one, many);
}

TEST(Picture, LineBehindAPlaneLeavesNoPixelAndInFrontItDoes) {
    const Mesh plane = square(0);
    for (const double depth : {0.05, 0.5, 5.0}) {
        const auto draw = [&](double z) {
            return decode_png(
                render_png(plane, {line({0.1, 0.2, z}, {0.9, 0.7, z})}, from_above()));
        };
        EXPECT_EQ(draw(-depth).red_pixels(), 0U) << "depth " << depth;
        EXPECT_GT(draw(depth).red_pixels(), 100U) << "depth " << depth;
    }
}

TEST(Picture, LineOnTheSurfaceIsSeenFromObliqueViewsToo) {
    const Mesh plane = square(0);
    for (const double elevation : {0.15, 0.5, 1.2}) {
        PictureOptions options = from_above();
        options.view = Vec3(0.3, -std::cos(elevation), std::sin(elevation));
        options.up = Vec3::UnitZ();
        const auto with = [&](double z) {
            return decode_png(render_png(plane, {line({0.1, 0.2, z}, {0.9, 0.7, z})}, options))
                .red_pixels();
        };
        const std::size_t free = with(0.2);
        EXPECT_GT(with(0), free * 9 / 10) << "elevation " << elevation;
        EXPECT_EQ(with(-0.01), 0U) << "elevation " << elevation;
    }
}

TEST(Picture, HalfHiddenLineIsCutWhereTheSurfaceBegins) {
    const Mesh plane = square(0);
    // The left half of the line runs in front of the square, the right half behind.
    const std::vector<PictureLayer> layers{line({0.1, 0.5, 0.4}, {0.9, 0.5, -0.4})};
    const DecodedPicture picture = decode_png(render_png(plane, layers, from_above()));
    std::size_t left = 0, right = 0;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const Color color = picture.at(x, y);
            const bool is_red = color.r > color.g + 40;
            (x < picture.width / 2 + 4 ? left : right) += is_red;
        }
    }
    EXPECT_GT(left, 100U);
    EXPECT_EQ(right, 0U);
}

TEST(Picture, LineWidthIsInPixels) {
    const Mesh plane = square(0);
    for (const double width : {2.0, 4.0, 8.0}) {
        const std::vector<PictureLayer> layers{line({0.1, 0.5, 0.1}, {0.9, 0.5, 0.1}, width)};
        const DecodedPicture picture = decode_png(render_png(plane, layers, from_above()));
        double red_share = 0;  // of the middle column, blends counted by their share
        const Color bare = picture.at(100, 40);
        for (int y = 60; y < 140; ++y)
            red_share += std::clamp((bare.g - picture.at(100, y).g) / double(bare.g), 0.0, 1.0);
        EXPECT_NEAR(red_share, width, 0.8);
    }
}

TEST(Picture, WireframeDarkensEdgesOnly) {
    const Mesh plane = square(0, 2);
    PictureOptions options = from_above();
    const DecodedPicture plain = decode_png(render_png(plane, {}, options));
    options.is_drawing_wireframe = true;
    const DecodedPicture wired = decode_png(render_png(plane, {}, options));
    EXPECT_LT(wired.at(100, 130).r + 40, plain.at(100, 130).r);  // on the middle edge
    EXPECT_EQ(wired.at(60, 80).r, plain.at(60, 80).r);           // inside a face
}

TEST(Picture, MeshWithoutFacesAndCurvesWithoutMeshAreDrawn) {
    EXPECT_EQ(decode_png(render_png(Mesh(), {}, from_above(10, 10))).red_pixels(), 0U);
    Mesh points;
    points.add_vertex({0, 0, 0});
    points.add_vertex({1, 1, 0});
    const auto picture = render_png(points, {line({0, 0, 0}, {1, 1, 0})}, from_above());
    EXPECT_GT(decode_png(picture).red_pixels(), 100U);
}

TEST(Picture, NonFinitePointsOfALayerAreLeftOut) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const PictureLayer layer{{{{0.2, 0.2, 0.1}, {nan, 0, 0}, {0.8, 0.8, 0.1}}}, kRed, 3};
    EXPECT_GT(decode_png(render_png(square(0), {layer}, from_above())).red_pixels(), 100U);
}

TEST(Picture, ImpossibleOptionsAreRefused) {
    PictureOptions options;
    options.width = 0;
    EXPECT_THROW(render_png(box(), {}, options), InputError);
    options.width = 1000000;
    EXPECT_THROW(render_png(box(), {}, options), InputError);
    options = {};
    options.view = Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 1);
    EXPECT_THROW(render_png(box(), {}, options), InputError);
}

TEST(Camera, FramesAreOrthonormalAndRightHanded) {
    for (const Vec3& view : {Vec3(1, 2, 3), Vec3(0, 0, -5), Vec3(0, 1, 0)}) {
        const CameraFrame frame = make_camera(view, Vec3::UnitY());
        EXPECT_NEAR((frame.right.cross(frame.up) - frame.toward).norm(), 0, 1e-12);
        EXPECT_NEAR(frame.toward.dot(view.normalized()), 1, 1e-12);
        EXPECT_NEAR(frame.right.norm(), 1, 1e-12);
    }
}

TEST(Camera, LooksOntoTheLargestExtentOfFlatObjects) {
    for (int thin = 0; thin < 3; ++thin) {
        Mesh mesh = box();
        for (const VertexHandle vertex : mesh.vertices()) mesh.point(vertex)[thin] *= 0.05;
        EXPECT_GT(std::abs(choose_camera(mesh).toward[thin]), 0.6) << "axis " << thin;
    }
}

TEST(Camera, SeesThreeSidesOfABox) {
    const CameraFrame camera = choose_camera(box());
    EXPECT_GT(camera.toward.cwiseAbs().minCoeff(), 0.2);
}

TEST(Camera, ProjectionFitsTheMeshIntoThePicture) {
    const Mesh mesh = box();
    const Projection projection(choose_camera(mesh), mesh, 300, 200);
    double widest = 0;
    for (const VertexHandle vertex : mesh.vertices()) {
        const Vec3 pixel = projection(mesh.point(vertex));
        EXPECT_GT(pixel[0], 0);
        EXPECT_LT(pixel[0], 300);
        EXPECT_GT(pixel[1], 0);
        EXPECT_LT(pixel[1], 200);
        widest = std::max({widest, std::abs(pixel[0] - 150) / 150, std::abs(pixel[1] - 100) / 100});
    }
    EXPECT_GT(widest, 0.85);
}

}  // namespace
}  // namespace fcn
