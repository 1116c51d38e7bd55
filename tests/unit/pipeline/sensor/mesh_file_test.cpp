#include "pipeline/sensor/mesh_file.hpp"

#include <cstring>
#include <random>

#include <gtest/gtest.h>

namespace kinectlab {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text) {
    return {text.begin(), text.end()};
}

template <class T>
void append(Bytes& bytes, T value, bool big_endian = false) {
    std::array<std::uint8_t, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big_endian) std::reverse(raw.begin(), raw.end());
    bytes.insert(bytes.end(), raw.begin(), raw.end());
}

// A tetrahedron with its corner at the origin, in every format.
const std::string kObj =
    "# made by hand\nmtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\r\nv 0 0 3 1.0\nvn 0 0 1\n"
    "f 1/1/1 2//1 3\nf 1 2 4\nf 1 3 -1\nf -3 -2 -1\n";
const std::string kAsciiPly =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty float z\nproperty uchar red\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0 255\n1 0 0 0\n0 2 0 0\n0 0 3 7\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n";

Bytes binary_ply(bool big_endian) {
    Bytes file = bytes_of(
        std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
        "_endian 1.0\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\n"
        "property list uchar short of_no_use\nelement face 4\n"
        "property list uchar int vertex_index\nend_header\n"
    );
    const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    for (const auto& corner : corners) {
        append(file, corner[0], big_endian);
        append(file, static_cast<double>(corner[1]), big_endian);
        append(file, corner[2], big_endian);
        append(file, std::uint8_t{2});
        append(file, std::int16_t{1}, big_endian);
        append(file, std::int16_t{-1}, big_endian);
    }
    const std::int32_t faces[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
    for (const auto& face : faces) {
        append(file, std::uint8_t{3});
        for (const auto index : face)
            append(file, index, big_endian);
    }
    return file;
}

const float kFacets[4][3][3] = {
    {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}},
    {{0, 0, 0}, {1, 0, 0}, {0, 0, 3}},
    {{0, 0, 0}, {0, 2, 0}, {0, 0, 3}},
    {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}};

Bytes binary_stl(const std::string& head = "solid, says its head, but it is binary") {
    Bytes file = bytes_of(head);
    file.resize(80);
    append(file, std::uint32_t{4});
    for (const auto& facet : kFacets) {
        for (int i = 0; i < 3; ++i)
            append(file, 0.0F);
        for (const auto& corner : facet)
            for (const float value : corner)
                append(file, value);
        append(file, std::uint16_t{0});
    }
    return file;
}

Bytes ascii_stl() {
    std::string text = "solid corner\n";
    for (const auto& facet : kFacets) {
        text += " facet normal 0 0 0\n  outer loop\n";
        for (const auto& corner : facet)
            text += "   vertex " + std::to_string(corner[0]) + " " + std::to_string(corner[1]) +
                    " " + std::to_string(corner[2]) + "\n";
        text += "  endloop\n endfacet\n";
    }
    return bytes_of(text + "endsolid corner\n");
}

using Parser = Result<MeshFile> (*)(std::span<const std::uint8_t>, const std::string&);

struct Format {
    const char* name;
    Bytes file;
    Parser parse;
};

std::vector<Format> formats() {
    return {
        {"obj", bytes_of(kObj), parse_obj},
        {"ascii ply", bytes_of(kAsciiPly), parse_ply},
        {"little-endian ply", binary_ply(false), parse_ply},
        {"big-endian ply", binary_ply(true), parse_ply},
        {"ascii stl", ascii_stl(), parse_stl},
        {"binary stl", binary_stl(), parse_stl}};
}

TEST(MeshFile, EveryFormatHoldsTheSameTetrahedron) {
    for (const auto& format : formats()) {
        const auto read = format.parse(format.file, "file");
        ASSERT_TRUE(read.has_value()) << format.name << ": " << to_text(read.error());
        const auto& mesh = read->mesh;
        EXPECT_EQ(mesh.vertices.size(), 4U) << format.name;
        ASSERT_EQ(mesh.triangles.size(), 4U) << format.name;
        double volume = 0.0, area = 0.0;
        for (const auto& t : mesh.triangles) {
            const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>(),
                                  b = mesh.vertices[t[1]].cast<double>(),
                                  c = mesh.vertices[t[2]].cast<double>();
            volume += std::abs(a.dot(b.cross(c))) / 6.0;
            area += 0.5 * (b - a).cross(c - a).norm();
        }
        EXPECT_NEAR(volume, 1.0, 1e-6) << format.name;
        EXPECT_NEAR(area, 1.0 + 1.5 + 3.0 + 3.5, 1e-5) << format.name;
    }
}

TEST(MeshFile, EveryTruncationIsAnErrorOrFewerTriangles) {
    for (const auto& format : formats())
        for (std::size_t size = 0; size < format.file.size(); ++size) {
            const auto read = format.parse(std::span(format.file).first(size), "file");
            if (!read) {
                EXPECT_FALSE(read.error().message.empty());
                continue;
            }
            EXPECT_LE(read->mesh.triangles.size(), 4U) << format.name << " at " << size;
        }
}

TEST(MeshFile, DamagedBytesNeverGiveAMeshThatPointsOutsideItself) {
    std::mt19937 random(7);
    for (const auto& format : formats())
        for (int round = 0; round < 3000; ++round) {
            Bytes file = format.file;
            for (int k = 0; k < 1 + round % 4; ++k)
                file[random() % file.size()] = static_cast<std::uint8_t>(random());
            const auto read = format.parse(file, "file");
            if (!read) continue;
            for (const auto& vertex : read->mesh.vertices)
                ASSERT_TRUE(vertex.allFinite());
            for (const auto& t : read->mesh.triangles)
                for (const auto index : t)
                    ASSERT_LT(index, read->mesh.vertices.size());
        }
}

TEST(MeshFile, ClaimsBeyondTheFileAreRefusedBeforeMemoryIsTaken) {
    const auto ply = parse_ply(
        bytes_of("ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\n"
                 "property float x\nproperty float y\nproperty float z\nend_header\n1234"),
        "huge.ply"
    );
    ASSERT_FALSE(ply.has_value());
    EXPECT_NE(to_text(ply.error()).find("4000000000"), std::string::npos);

    Bytes stl = binary_stl();
    stl[83] = 0x7F;
    const auto read = parse_stl(stl, "huge.stl");
    ASSERT_FALSE(read.has_value());
    EXPECT_NE(read.error().message.find("facets"), std::string::npos);
}

TEST(MeshFile, WrongIndicesNameTheLine) {
    for (const char* face : {"f 1 2 4", "f 0 1 2", "f 1 2 -4", "f 1 2", "f 1 two 3"}) {
        const auto read =
            parse_obj(bytes_of(std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\n") + face), "m");
        ASSERT_FALSE(read.has_value()) << face;
        EXPECT_EQ(read.error().field, "m:4") << face;
        EXPECT_NE(read.error().message.find('"' + std::string(face) + '"'), std::string::npos);
    }
}

TEST(MeshFile, WhatIsNotFiniteOrHasNoAreaIsLeftOutAndTold) {
    const auto read = parse_obj(
        bytes_of(
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 1 2\n"
        ),
        "m"
    );
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->mesh.triangles.size(), 1U);
    EXPECT_EQ(read->dropped_vertices, 1U);
    EXPECT_EQ(read->dropped_triangles, 3U);
    const auto warnings = mesh_warnings(*read, "m.obj", 1.0);
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_NE(warnings[0].find("left out 1 points"), std::string::npos) << warnings[0];
}

TEST(MeshFile, HolesAreToldWithTheNumbers) {
    // A tetrahedron, its corners repeated for each face as many files do, then without one face.
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 0\nv 1 0 0\n";
    const std::string three = "f 1 3 2\nf 5 6 4\nf 1 4 3\n";
    const auto closed = parse_obj(bytes_of(corners + three + "f 2 3 4\n"), "m");
    EXPECT_TRUE(mesh_warnings(*closed, "m.obj", 1.0).empty());
    const auto open = mesh_warnings(*parse_obj(bytes_of(corners + three), "m"), "m.obj", 1.0);
    ASSERT_EQ(open.size(), 1U);
    EXPECT_NE(open[0].find("3 of 6 edges"), std::string::npos) << open[0];
}

TEST(MeshFile, AModelInCentimetresIsNotTakenForMillimetres) {
    MeshFile box;
    box.mesh.vertices = {{0, 0, 0}, {16, 10, 12}};
    const auto warnings = mesh_warnings(box, "box.stl", 1.0);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("centimetres (0.16 x 0.1 x 0.12 m)"), std::string::npos);
    EXPECT_EQ(warnings[0].find("millimetres"), std::string::npos) << warnings[0];
}

TEST(MeshFile, NothingLeftIsAnError) {
    EXPECT_FALSE(parse_obj(bytes_of(""), "m").has_value());
    EXPECT_FALSE(parse_obj(bytes_of("v nan nan nan\n"), "m").has_value());
    EXPECT_FALSE(parse_obj(bytes_of("v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n"), "m").has_value());
    EXPECT_FALSE(parse_stl(bytes_of("solid nothing\nendsolid\n"), "m").has_value());
    const auto blank = parse_pcd_points(
        bytes_of("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
                 "POINTS 2\nDATA ascii\nnan nan nan\nnan nan nan\n"),
        "m.pcd"
    );
    ASSERT_FALSE(blank);
    EXPECT_EQ(blank.error().message, "holds no reading: all 2 points are NaN");
    const auto wild = parse_obj(bytes_of("v nan nan nan\nv inf 0 0\n"), "m");
    EXPECT_NE(wild.error().message.find("all 2 "), std::string::npos) << wild.error().message;
}

TEST(MeshFile, SizesThatLookLikeMillimetresAreToldWithTheNumbers) {
    MeshFile box;
    box.mesh.vertices = {{0, 0, 0}, {160, 100, 120}};
    const auto warnings = mesh_warnings(box, "box.stl", 1.0);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("160 x 100 x 120 m"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("0.16 x 0.1 x 0.12 m"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("model_unit_m to 0.001"), std::string::npos) << warnings[0];
    EXPECT_TRUE(mesh_warnings(box, "box.stl", 0.001).empty());
    EXPECT_EQ(mesh_warnings(box, "box.stl", 1e-6).size(), 1U);
}

TEST(MeshFile, AListOfPointsIsAModelButNoFrame) {
    const auto read = parse_pcd_points(
        bytes_of(
            "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\n"
            "POINTS 3\nDATA ascii\n0 0 0\nnan nan nan\n1 2 3\n"
        ),
        "m.pcd"
    );
    ASSERT_TRUE(read.has_value()) << to_text(read.error());
    EXPECT_EQ(read->mesh.vertices.size(), 2U);
    EXPECT_TRUE(read->mesh.is_cloud());
}

TEST(MeshFile, UnknownEndingsAndMissingFilesSaySo) {
    EXPECT_NE(to_text(read_mesh("thing.dae").error()).find(".ply, .obj, .stl"), std::string::npos);
    EXPECT_EQ(read_mesh("/no/such/thing.ply").error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace kinectlab
