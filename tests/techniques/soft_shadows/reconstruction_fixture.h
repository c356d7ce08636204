// A device, depth images of small scenes and their reconstruction.
#pragma once

#include "techniques/kit/depth_image_renderer.h"
#include "techniques/soft_shadows/reconstruction.h"
#include "tests/gl/suite_device.h"
#include "tests/techniques/kit/write_depth_image.h"
#include "tests/techniques/soft_shadows/reference_mesh.h"

namespace gfxrepro::soft_shadows {

using kit::viewOf;

/// An image and its offset image, in the host's memory.
struct ImagePair {
    kit::HostDepthImage image;
    kit::HostDepthImage offset;
};

/// A reconstruction, read back.
struct HostMesh {
    ReconstructedMesh mesh;
    std::vector<CornerVertex> vertices;
    std::vector<glm::uvec3> triangles;
};

struct ReconstructionTest : test::SuiteDeviceTest {
    static HostMesh reconstruct(const ImagePair& images, std::span<const glm::vec3> normals,
                                const ReconstructionSettings& settings) {
        using kit::DepthFormat;
        using kit::DepthImage;
        DepthImage image(images.image.view, DepthFormat::Float32);
        DepthImage offset(images.offset.view, DepthFormat::Float32);
        writeDepthImage(images.image, image);
        writeDepthImage(images.offset, offset);
        std::vector<glm::vec4> padded;
        for (const glm::vec3& n : normals) padded.emplace_back(n, 0.0F);
        return readBack(
            Reconstructor(shaders(), settings).reconstruct(image, &offset, gl::Buffer::of(padded)));
    }

    static HostMesh readBack(ReconstructedMesh mesh) {
        HostMesh host;
        host.vertices = mesh.vertices.read<CornerVertex>(mesh.vertexCount);
        host.triangles = mesh.indices.read<glm::uvec3>(mesh.triangleCount);
        host.mesh = std::move(mesh);
        return host;
    }
};

/// All triangles are counter-clockwise as the eye sees them.
inline void expectFacesEye(const HostMesh& measured) {
    const scene::Mesh mesh = toWorldMesh(measured.mesh);
    const glm::vec3 eye = measured.mesh.view.eyeWorld;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x] - eye), b(mesh.positions[t.y] - eye),
            c(mesh.positions[t.z] - eye);
        ASSERT_LT(glm::dot(glm::cross(b - a, c - a), a), 0.0);
    }
}

/// An image without samples.
kit::HostDepthImage emptyImage(const kit::View& view);
/// Both without samples, seen from the origin.
ImagePair emptyPair(glm::ivec2 sizePx);
/// By ray casting: the nearest triangle, of either side, through the middle of each
/// pixel.
ImagePair traceImages(const scene::Mesh& mesh, const scene::Camera& camera, glm::ivec2 sizePx);
/// A camera at the origin that looks along −z; a pixel's footprint at depth d is d · 2 / size.y.
scene::Camera originCamera();

}  // namespace gfxrepro::soft_shadows
