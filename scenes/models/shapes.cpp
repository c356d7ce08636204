#include "scenes/models/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace gfxrepro::scene::shapes {

using glm::vec3;
using sdf::ball;
using sdf::box;
using sdf::capsule;
using sdf::ellipsoid;
using sdf::Relief;
using sdf::Shape;

namespace {

/// A thin cambered profile that twists on its way up, from y = −0.6 to 0.98.
float airfoil(const vec3& p) {
    const float up = std::clamp((p.y + 0.6F) / 1.58F, 0.0F, 1.0F);
    const float twistRad = 0.15F + 0.75F * up;
    const float c = sdf::cosine(twistRad);
    const float s = sdf::sine(twistRad);
    const float across = c * p.x - s * p.z;
    const float along = s * p.x + c * p.z;
    const float halfChord = 0.5F - 0.12F * up;
    const float u = std::clamp(along / halfChord, -1.0F, 1.0F);
    const float camber = 0.2F * (1.0F - u * u) - 0.1F;
    const float halfThickness = 0.02F + (0.075F - 0.045F * up) * (1.0F - u * u) * (0.7F - 0.3F * u);
    const float side = std::abs(across - camber) - halfThickness;
    const float ends = std::max({std::abs(along) - halfChord, p.y - 0.98F, -0.6F - p.y});
    // Half the value: camber and twist make the field about twice as steep as the distance.
    return 0.5F * std::max(side, ends);
}

/// A point of a curve with the radius of a body around it.
struct Station {
    vec3 position;
    float radius;
};

/// The Catmull–Rom spline between stations i and i + 1 at t in [0, 1].
Station onSpline(std::span<const Station> stations, std::size_t i, float t) {
    const auto at = [&](std::size_t k) { return stations[std::min(k, stations.size() - 1)]; };
    const Station a = at(i == 0 ? 0 : i - 1);
    const Station b = at(i);
    const Station c = at(i + 1);
    const Station d = at(i + 2);
    const vec3 position =
        b.position +
        0.5F * t *
            (c.position - a.position +
             t * (2.0F * a.position - 5.0F * b.position + 4.0F * c.position - d.position +
                  t * (3.0F * (b.position - c.position) + d.position - a.position)));
    return {position, b.radius + t * (c.radius - b.radius)};
}

}  // namespace

Shape sphere(std::uint32_t) {
    return Shape().add(ball(vec3(0), 1.0F));
}

Shape torus(std::uint32_t) {
    return Shape().add(sdf::torus(vec3(0), 0.7F, 0.3F));
}

Shape linkedTori(std::uint32_t) {
    return Shape()
        .add(sdf::torus({-0.3F, 0, 0}, 0.5F, 0.12F))
        .add(sdf::torus({0.3F, 0, 0}, 0.5F, 0.12F).pointing({0, 0, 1}));
}

Shape duck(std::uint32_t) {
    Shape duck;
    duck.add(ellipsoid({0, -0.42F, -0.1F}, {0.52F, 0.42F, 0.78F}));
    duck.add(ball({0, -0.35F, 0.4F}, 0.38F), 0.2F);                               // breast
    duck.add(capsule({0, -0.3F, -0.6F}, {0, 0.06F, -1.0F}, 0.26F, 0.11F), 0.2F);  // tail
    duck.addPair(ellipsoid({0.45F, -0.3F, -0.2F}, {0.1F, 0.26F, 0.5F}), 0.1F);    // wings
    duck.add(capsule({0, -0.1F, 0.42F}, {0, 0.35F, 0.45F}, 0.26F, 0.2F), 0.15F);  // neck
    duck.add(ball({0, 0.5F, 0.5F}, 0.33F), 0.1F);                                 // head
    duck.add(ellipsoid({0, 0.46F, 0.88F}, {0.2F, 0.1F, 0.3F}), 0.06F);            // bill
    duck.add(ellipsoid({0, 0.36F, 0.82F}, {0.15F, 0.08F, 0.22F}), 0.03F);
    duck.addPair(ball({0.2F, 0.6F, 0.73F}, 0.08F), 0.02F);  // eyes
    return duck;
}

Shape bunny(std::uint32_t seed) {
    Shape bunny;
    bunny.add(ellipsoid({0, -0.4F, -0.15F}, {0.5F, 0.52F, 0.68F}));
    bunny.add(ball({0, -0.2F, 0.33F}, 0.36F), 0.25F);                               // chest
    bunny.addPair(ellipsoid({0.36F, -0.58F, -0.2F}, {0.22F, 0.34F, 0.42F}), 0.1F);  // haunches
    bunny.add(ellipsoid({0, 0.25F, 0.5F}, {0.28F, 0.29F, 0.34F}), 0.2F);            // head
    bunny.addPair(ball({0.08F, 0.15F, 0.72F}, 0.14F), 0.1F);                        // cheeks
    bunny.add(ball({0, 0.22F, 0.85F}, 0.04F), 0.03F);                               // nose
    bunny.addPair(ball({0.22F, 0.33F, 0.65F}, 0.06F), 0.03F);                       // eyes
    // Ears lean back; their hollow faces forward.
    bunny.addPair(ellipsoid({0.2F, 0.72F, 0.22F}, {0.13F, 0.36F, 0.07F}).pointing({0.3F, 1, -0.5F}),
                  0.08F);
    bunny.addPair(capsule({0.16F, -0.4F, 0.5F}, {0.18F, -0.86F, 0.62F}, 0.13F, 0.09F), 0.1F);
    bunny.addPair(ellipsoid({0.2F, -0.91F, 0.68F}, {0.1F, 0.07F, 0.15F}), 0.05F);   // front paws
    bunny.addPair(ellipsoid({0.36F, -0.89F, 0.1F}, {0.13F, 0.09F, 0.36F}), 0.06F);  // hind feet
    bunny.add(ball({0, -0.6F, -0.85F}, 0.17F), 0.06F);                              // tail
    bunny.setRelief({Relief::Kind::Bumps, 0.012F, 9.0F, seed});
    return bunny;
}

Shape lion(std::uint32_t seed) {
    Shape lion;
    lion.add(box({0, -0.9F, 0}, {0.52F, 0.1F, 0.85F}, 0.03F));  // plinth
    lion.add(capsule({0, -0.42F, -0.42F}, {0, 0.12F, 0.14F}, 0.36F, 0.32F), 0.02F);
    lion.add(ellipsoid({0, -0.06F, 0.28F}, {0.3F, 0.38F, 0.22F}), 0.12F);            // chest
    lion.addPair(ellipsoid({0.29F, -0.53F, -0.36F}, {0.18F, 0.29F, 0.36F}), 0.06F);  // haunches
    lion.addPair(ellipsoid({0.38F, -0.75F, 0.02F}, {0.12F, 0.08F, 0.26F}), 0.03F);   // hind paws
    lion.addPair(capsule({0.2F, -0.05F, 0.36F}, {0.22F, -0.7F, 0.44F}, 0.15F, 0.1F), 0.05F);
    for (const float x : {0.14F, 0.22F, 0.3F}) {  // toes
        lion.addPair(capsule({x, -0.76F, 0.46F}, {x, -0.77F, 0.62F}, 0.06F, 0.05F), 0.02F);
    }
    lion.add(capsule({0.1F, -0.7F, -0.74F}, {0.46F, -0.74F, -0.6F}, 0.06F, 0.05F), 0.04F);  // tail
    lion.add(capsule({0.46F, -0.74F, -0.6F}, {0.47F, -0.72F, -0.3F}, 0.05F, 0.09F), 0.03F);
    // The mane: locks around the face, in two rows, and down the chest.
    lion.add(ellipsoid({0, 0.46F, 0.22F}, {0.4F, 0.46F, 0.3F}), 0.1F);
    constexpr int kLocks = 18;
    for (int i = 0; i < kLocks; ++i) {
        const float turnRad = 6.2831853F * static_cast<float>(i) / static_cast<float>(kLocks);
        const vec3 out(sdf::sine(turnRad), sdf::cosine(turnRad), 0);
        const vec3 face(0, 0.5F, 0.4F), nape(0, 0.44F, 0.16F);
        lion.add(capsule(face + 0.25F * out, nape + 0.42F * out, 0.07F, 0.05F), 0.02F);
        lion.add(
            capsule(nape + 0.36F * out, nape + 0.47F * out - vec3(0, 0.1F, 0.14F), 0.07F, 0.025F),
            0.02F);
    }
    for (const float x : {0.0F, 0.1F, 0.2F}) {
        lion.addPair(capsule({x, 0.2F, 0.46F}, {0.7F * x, -0.2F - x, 0.5F}, 0.06F, 0.02F), 0.02F);
    }
    lion.add(ellipsoid({0, 0.54F, 0.44F}, {0.25F, 0.27F, 0.24F}), 0.03F);          // head
    lion.addPair(ellipsoid({0.075F, 0.43F, 0.64F}, {0.11F, 0.1F, 0.12F}), 0.03F);  // muzzle
    lion.add(capsule({0, 0.62F, 0.62F}, {0, 0.52F, 0.74F}, 0.06F, 0.07F), 0.04F);  // nose
    lion.add(ellipsoid({0, 0.51F, 0.78F}, {0.07F, 0.04F, 0.04F}), 0.02F);
    lion.add(ellipsoid({0, 0.32F, 0.58F}, {0.12F, 0.06F, 0.13F}), 0.03F);  // jaw
    lion.cut(capsule({-0.13F, 0.355F, 0.74F}, {0.13F, 0.355F, 0.74F}, 0.018F, 0.018F), 0.02F);
    for (const float side : {-1.0F, 1.0F}) {
        lion.cut(ellipsoid({side * 0.12F, 0.6F, 0.68F}, {0.06F, 0.04F, 0.05F}), 0.03F);
        lion.add(ball({side * 0.12F, 0.6F, 0.64F}, 0.035F), 0.008F);
        lion.add(capsule({side * 0.05F, 0.67F, 0.66F}, {side * 0.19F, 0.68F, 0.6F}, 0.03F, 0.02F),
                 0.03F);
        lion.add(ball({side * 0.25F, 0.8F, 0.36F}, 0.085F), 0.03F);  // ears
        lion.cut(ball({side * 0.255F, 0.81F, 0.43F}, 0.055F), 0.02F);
    }
    lion.setRelief({Relief::Kind::Bumps, 0.006F, 14.0F, seed});
    return lion;
}

Shape hugo(std::uint32_t) {
    Shape man;
    man.add(ellipsoid({0, 0.4F, 0}, {0.23F, 0.25F, 0.14F}));                         // chest
    man.add(ellipsoid({0, 0.13F, 0.01F}, {0.18F, 0.2F, 0.125F}), 0.12F);             // belly
    man.add(ellipsoid({0, -0.06F, -0.01F}, {0.2F, 0.15F, 0.145F}), 0.1F);            // hips
    man.addPair(ellipsoid({0.09F, 0.44F, 0.09F}, {0.11F, 0.085F, 0.055F}), 0.05F);   // pectorals
    man.add(capsule({0, 0.58F, -0.02F}, {0, 0.74F, 0.01F}, 0.085F, 0.065F), 0.08F);  // neck
    man.addPair(capsule({0.04F, 0.62F, -0.02F}, {0.22F, 0.56F, -0.01F}, 0.06F, 0.07F), 0.08F);
    man.add(ellipsoid({0, 0.86F, 0.02F}, {0.1F, 0.135F, 0.12F}), 0.03F);            // head
    man.add(ellipsoid({0, 0.79F, 0.06F}, {0.07F, 0.08F, 0.075F}), 0.04F);           // jaw
    man.add(capsule({0, 0.87F, 0.13F}, {0, 0.83F, 0.155F}, 0.012F, 0.02F), 0.02F);  // nose
    man.addPair(ellipsoid({0.1F, 0.85F, 0.01F}, {0.02F, 0.04F, 0.03F}), 0.015F);    // ears
    man.addPair(capsule({0.27F, 0.54F, 0}, {0.35F, 0.22F, -0.02F}, 0.085F, 0.055F), 0.06F);
    man.addPair(capsule({0.35F, 0.2F, -0.02F}, {0.42F, -0.07F, 0.08F}, 0.06F, 0.036F), 0.03F);
    man.addPair(ellipsoid({0.435F, -0.14F, 0.1F}, {0.03F, 0.07F, 0.05F}), 0.03F);  // hands
    man.addPair(capsule({0.43F, -0.18F, 0.1F}, {0.43F, -0.24F, 0.125F}, 0.035F, 0.025F), 0.02F);
    man.addPair(capsule({0.42F, -0.1F, 0.12F}, {0.405F, -0.17F, 0.16F}, 0.03F, 0.022F), 0.03F);
    man.addPair(capsule({0.11F, -0.1F, 0}, {0.13F, -0.48F, 0.02F}, 0.12F, 0.075F), 0.06F);
    man.addPair(capsule({0.13F, -0.5F, 0.02F}, {0.14F, -0.9F, -0.03F}, 0.075F, 0.042F), 0.03F);
    man.addPair(ellipsoid({0.135F, -0.62F, -0.035F}, {0.06F, 0.13F, 0.06F}), 0.04F);  // calves
    man.addPair(capsule({0.14F, -0.94F, -0.05F}, {0.18F, -0.96F, 0.16F}, 0.05F, 0.035F), 0.04F);
    return man;
}

Shape wagner(std::uint32_t seed) {
    Shape bust;
    bust.add(box({0, -0.92F, 0}, {0.3F, 0.1F, 0.26F}, 0.03F));  // plinth
    bust.add(capsule({0, -0.8F, 0}, {0, -0.5F, 0}, 0.17F, 0.22F), 0.06F);
    bust.add(ellipsoid({0, -0.3F, -0.02F}, {0.62F, 0.3F, 0.28F}), 0.1F);  // shoulders
    bust.add(ellipsoid({0, -0.38F, 0.12F}, {0.36F, 0.3F, 0.22F}), 0.1F);  // chest
    bust.addPair(capsule({0.07F, -0.02F, 0.16F}, {0.16F, -0.42F, 0.33F}, 0.05F, 0.06F), 0.04F);
    bust.add(sdf::torus({0, -0.02F, 0}, 0.19F, 0.055F), 0.04F);                    // collar
    bust.add(capsule({0, -0.1F, -0.02F}, {0, 0.2F, 0.02F}, 0.17F, 0.15F), 0.05F);  // neck
    bust.add(ellipsoid({0, 0.46F, 0}, {0.28F, 0.36F, 0.32F}), 0.06F);              // skull
    bust.add(ellipsoid({0, 0.26F, 0.13F}, {0.19F, 0.2F, 0.2F}), 0.08F);            // jaw
    bust.add(ball({0, 0.12F, 0.29F}, 0.07F), 0.06F);                               // chin
    bust.add(capsule({0, 0.5F, 0.3F}, {0, 0.36F, 0.39F}, 0.03F, 0.05F), 0.04F);    // nose
    bust.addPair(ball({0.05F, 0.34F, 0.35F}, 0.035F), 0.02F);
    bust.addPair(capsule({0.04F, 0.53F, 0.31F}, {0.2F, 0.52F, 0.24F}, 0.03F, 0.025F), 0.03F);
    bust.cut(ball({0.105F, 0.45F, 0.35F}, 0.055F), 0.04F);  // eyes
    bust.cut(ball({-0.105F, 0.45F, 0.35F}, 0.055F), 0.04F);
    bust.addPair(ball({0.105F, 0.455F, 0.28F}, 0.045F), 0.01F);
    bust.add(capsule({-0.06F, 0.23F, 0.33F}, {0.06F, 0.23F, 0.33F}, 0.018F, 0.018F), 0.015F);
    bust.add(capsule({-0.05F, 0.2F, 0.325F}, {0.05F, 0.2F, 0.325F}, 0.02F, 0.02F), 0.01F);
    bust.addPair(ellipsoid({0.28F, 0.4F, 0}, {0.04F, 0.1F, 0.07F}), 0.02F);     // ears
    bust.addPair(ellipsoid({0.27F, 0.3F, 0.1F}, {0.06F, 0.2F, 0.09F}), 0.06F);  // whiskers
    // Hair at the back, and the beret, worn to one side.
    bust.add(ellipsoid({0, 0.3F, -0.2F}, {0.29F, 0.3F, 0.18F}), 0.08F);
    bust.add(ellipsoid({0.05F, 0.8F, -0.05F}, {0.42F, 0.15F, 0.4F}).pointing({0.22F, 1, -0.12F}),
             0.05F);
    bust.setRelief({Relief::Kind::Bumps, 0.008F, 7.0F, seed});
    return bust;
}

Shape buddha(std::uint32_t seed) {
    Shape figure;
    figure.add(ellipsoid({0, -0.88F, 0.1F}, {0.78F, 0.13F, 0.6F}));  // seat
    figure.add(sdf::torus({0, -0.78F, 0.1F}, 0.62F, 0.06F), 0.04F);
    for (int i = 0; i < 16; ++i) {  // lotus leaves around it
        const float angleRad = static_cast<float>(i) * 0.392699F;
        const vec3 out(sdf::sine(angleRad), 0, sdf::cosine(angleRad));
        figure.add(ellipsoid({0.7F * out.x, -0.84F, 0.1F + 0.55F * out.z}, {0.12F, 0.12F, 0.05F})
                       .pointing({0.6F * out.x, 1, 0.6F * out.z}),
                   0.03F);
    }
    figure.add(ellipsoid({0, -0.3F, 0.06F}, {0.4F, 0.36F, 0.32F}), 0.05F);  // belly
    figure.add(ellipsoid({0, 0.08F, 0}, {0.36F, 0.28F, 0.23F}), 0.15F);     // chest
    figure.addPair(ball({0.36F, 0.2F, -0.02F}, 0.14F), 0.1F);               // shoulders
    figure.addPair(capsule({0.18F, -0.6F, 0.05F}, {0.66F, -0.66F, 0.3F}, 0.2F, 0.14F), 0.08F);
    figure.addPair(capsule({0.64F, -0.68F, 0.32F}, {-0.05F, -0.68F, 0.56F}, 0.13F, 0.09F), 0.05F);
    figure.addPair(capsule({0.43F, 0.18F, -0.02F}, {0.55F, -0.22F, 0.04F}, 0.115F, 0.095F), 0.05F);
    figure.addPair(capsule({0.55F, -0.25F, 0.05F}, {0.14F, -0.48F, 0.46F}, 0.095F, 0.06F), 0.04F);
    figure.add(ellipsoid({0, -0.53F, 0.5F}, {0.17F, 0.05F, 0.11F}), 0.03F);  // hands
    // The robe: folds from the left shoulder to the right hip.
    for (int i = 0; i < 4; ++i) {
        const float shift = static_cast<float>(i) * 0.085F;
        figure.add(capsule({0.3F - shift, 0.3F - 0.4F * shift, 0.16F + 0.1F * shift},
                           {-0.26F - 0.3F * shift, -0.18F - shift, 0.27F}, 0.03F, 0.025F),
                   0.05F);
    }
    figure.add(capsule({0, 0.25F, 0}, {0, 0.48F, 0.02F}, 0.12F, 0.105F), 0.06F);        // neck
    figure.add(ellipsoid({0, 0.64F, 0.04F}, {0.2F, 0.235F, 0.21F}), 0.04F);             // head
    figure.add(ellipsoid({0, 0.54F, 0.1F}, {0.145F, 0.13F, 0.14F}), 0.06F);             // jaw
    figure.add(ball({0, 0.9F, -0.01F}, 0.1F), 0.05F);                                   // topknot
    figure.add(capsule({0, 0.68F, 0.235F}, {0, 0.6F, 0.265F}, 0.018F, 0.032F), 0.03F);  // nose
    figure.addPair(ellipsoid({0.08F, 0.665F, 0.22F}, {0.05F, 0.02F, 0.02F}), 0.02F);    // eyelids
    figure.add(ellipsoid({0, 0.53F, 0.235F}, {0.06F, 0.02F, 0.02F}), 0.015F);           // mouth
    figure.addPair(ellipsoid({0.205F, 0.58F, 0.02F}, {0.03F, 0.14F, 0.05F}), 0.02F);    // ears
    figure.setRelief({Relief::Kind::Bumps, 0.006F, 9.0F, seed});
    return figure;
}

Shape blade(std::uint32_t) {
    Shape blade;
    blade.add(box({0, -0.56F, 0}, {0.4F, 0.05F, 0.58F}, 0.02F));         // platform
    blade.add(box({0, -0.78F, 0}, {0.24F, 0.22F, 0.5F}, 0.03F), 0.05F);  // root
    for (const float y : {-0.72F, -0.9F}) {  // the fir-tree grooves that hold it in the disc
        for (const float side : {-1.0F, 1.0F}) {
            blade.cut(capsule({side * 0.27F, y, -0.7F}, {side * 0.27F, y, 0.7F}, 0.075F, 0.075F),
                      0.02F);
        }
    }
    blade.add(sdf::custom(&airfoil), 0.06F);
    // Cooling holes along the leading edge and a slot in the root.
    blade.cut(capsule({0, -1.1F, 0.2F}, {0, -0.85F, 0.2F}, 0.07F, 0.07F), 0.01F);
    blade.cut(capsule({0, -1.1F, -0.2F}, {0, -0.85F, -0.2F}, 0.07F, 0.07F), 0.01F);
    return blade;
}

Shape brain(std::uint32_t seed) {
    Shape brain;
    brain.addPair(ellipsoid({0.28F, 0.14F, 0.02F}, {0.4F, 0.56F, 0.88F}), 0.03F);
    brain.addPair(ellipsoid({0.42F, -0.1F, 0.2F}, {0.3F, 0.28F, 0.5F}), 0.1F);        // temporal
    brain.addPair(ellipsoid({0.2F, -0.42F, -0.52F}, {0.3F, 0.2F, 0.28F}), 0.03F);     // cerebellum
    brain.add(capsule({0, -0.2F, -0.15F}, {0, -0.85F, -0.4F}, 0.17F, 0.11F), 0.08F);  // stem
    brain.setRelief({Relief::Kind::Grooves, 0.03F, 3.8F, seed});
    return brain;
}

Shape dragon(std::uint32_t seed) {
    // From the tip of the tail over the back to the neck.
    constexpr Station kSpine[] = {
        {{0.32F, -0.52F, -0.72F}, 0.02F},  {{0.42F, -0.8F, -0.95F}, 0.05F},
        {{0.0F, -0.84F, -1.12F}, 0.075F},  {{-0.3F, -0.74F, -0.9F}, 0.11F},
        {{-0.12F, -0.52F, -0.62F}, 0.16F}, {{0.04F, -0.12F, -0.5F}, 0.22F},
        {{0.08F, 0.08F, -0.2F}, 0.24F},    {{0.0F, -0.2F, 0.08F}, 0.23F},
        {{-0.04F, -0.25F, 0.35F}, 0.22F},  {{0.0F, 0.05F, 0.58F}, 0.17F},
        {{0.03F, 0.4F, 0.55F}, 0.13F},     {{0.0F, 0.62F, 0.66F}, 0.12F}};
    constexpr int kSteps = 3;
    Shape dragon;
    Station last = kSpine[0];
    for (std::size_t i = 0; i + 1 < std::size(kSpine); ++i) {
        for (int k = 1; k <= kSteps; ++k) {
            const Station now =
                onSpline(kSpine, i, static_cast<float>(k) / static_cast<float>(kSteps));
            dragon.add(capsule(last.position, now.position, last.radius, now.radius),
                       0.2F * now.radius);
            if (k != 2) {  // a spike of the crest, upright and swept back
                const vec3 root = now.position + vec3(0, 0.8F * now.radius, 0);
                dragon.add(capsule(root, root + vec3(0, 0.06F + 0.6F * now.radius, -0.09F),
                                   0.05F + 0.1F * now.radius, 0.012F),
                           0.03F);
            }
            last = now;
        }
    }
    const auto addLeg = [&](const vec3& hip, const vec3& knee, const vec3& foot, float radius) {
        dragon.add(capsule(hip, knee, radius, 0.7F * radius), 0.1F);
        dragon.add(capsule(knee, foot, 0.7F * radius, 0.45F * radius), 0.05F);
        for (const float side : {-0.07F, 0.0F, 0.07F}) {  // claws
            dragon.add(capsule(foot, foot + vec3(side, -0.05F, 0.15F), 0.045F, 0.014F), 0.04F);
        }
    };
    addLeg({0.2F, -0.2F, -0.42F}, {0.42F, -0.4F, -0.3F}, {0.4F, -0.86F, -0.42F}, 0.17F);
    addLeg({-0.12F, -0.25F, -0.42F}, {-0.36F, -0.45F, -0.25F}, {-0.36F, -0.86F, -0.36F}, 0.17F);
    addLeg({0.14F, -0.3F, 0.36F}, {0.34F, -0.5F, 0.3F}, {0.32F, -0.86F, 0.42F}, 0.14F);
    addLeg({-0.16F, -0.3F, 0.36F}, {-0.34F, -0.48F, 0.36F}, {-0.36F, -0.86F, 0.5F}, 0.14F);
    // Head: skull, long snout, open jaw, brows, horns, whiskers.
    dragon.add(ellipsoid({0, 0.68F, 0.74F}, {0.16F, 0.14F, 0.2F}), 0.06F);
    dragon.add(capsule({0, 0.68F, 0.85F}, {0, 0.62F, 1.12F}, 0.11F, 0.075F), 0.05F);
    dragon.add(capsule({0, 0.55F, 0.74F}, {0, 0.4F, 1.0F}, 0.08F, 0.045F), 0.04F);
    dragon.addPair(ball({0.05F, 0.69F, 1.14F}, 0.04F), 0.02F);
    dragon.addPair(ball({0.11F, 0.77F, 0.84F}, 0.05F), 0.03F);
    dragon.addPair(capsule({0.09F, 0.78F, 0.7F}, {0.2F, 0.98F, 0.4F}, 0.05F, 0.014F), 0.03F);
    dragon.addPair(capsule({0.12F, 0.62F, 0.68F}, {0.3F, 0.62F, 0.5F}, 0.07F, 0.02F), 0.03F);
    dragon.setRelief({Relief::Kind::Bumps, 0.014F, 14.0F, seed});
    return dragon;
}

// Stand-ins for scanned parts of the body: hand, head, hip bone.

namespace {

struct Finger {
    vec3 root, direction;  // of the first phalanx; it bends forwards (+z) at each joint
    float length, radius;
};

/// Three phalanges, thicker at the joints, with a pad before and a nail behind the tip.
void addFinger(Shape& hand, const Finger& finger) {
    constexpr float kShares[] = {0.44F, 0.31F, 0.25F};
    constexpr float kBendsForward = 0.09F;
    vec3 joint = finger.root, direction = glm::normalize(finger.direction);
    float radius = finger.radius;
    for (const float share : kShares) {
        const vec3 next = joint + share * finger.length * direction;
        hand.add(ball(joint, 1.06F * radius), 0.03F);
        hand.add(capsule(joint, next, 0.97F * radius, 0.86F * radius), 0.03F);
        // Creases on the palm's side of the joint.
        const vec3 crease = joint + vec3(0, 0, 1.04F * radius);
        hand.cut(capsule(crease - vec3(radius, 0, 0), crease + vec3(radius, 0, 0), 0.01F, 0.01F),
                 0.02F);
        joint = next;
        radius *= 0.88F;
        direction = glm::normalize(direction + vec3(0, 0, kBendsForward));
    }
    hand.add(ellipsoid(joint - 0.06F * direction + vec3(0, 0, 0.25F * radius),
                       {0.95F * radius, 1.5F * radius, 0.85F * radius})
                 .pointing(direction),
             0.03F);
    hand.add(ellipsoid(joint - 0.02F * direction - vec3(0, 0, 0.72F * radius),
                       {0.72F * radius, 1.15F * radius, 0.3F * radius})
                 .pointing(direction),
             0.008F);
}

/// Sockets, balls with lids, brows.
void addEyes(Shape& head) {
    for (const float side : {-1.0F, 1.0F}) {
        head.cut(ellipsoid({side * 0.175F, 0.13F, 0.56F}, {0.125F, 0.085F, 0.11F}), 0.1F);
        head.add(ball({side * 0.17F, 0.125F, 0.405F}, 0.083F), 0.008F);
        // Lids: a shell around the ball with a slit.
        Shape& withLids =
            head.add(ellipsoid({side * 0.17F, 0.165F, 0.408F}, {0.105F, 0.055F, 0.095F}), 0.015F);
        withLids.add(ellipsoid({side * 0.17F, 0.075F, 0.402F}, {0.1F, 0.035F, 0.09F}), 0.02F);
        head.add(capsule({side * 0.06F, 0.235F, 0.5F}, {side * 0.29F, 0.25F, 0.4F}, 0.035F, 0.028F),
                 0.08F);
    }
}

void addNose(Shape& head) {
    head.add(capsule({0, 0.19F, 0.47F}, {0, -0.045F, 0.615F}, 0.035F, 0.052F), 0.07F);
    head.add(ball({0, -0.055F, 0.62F}, 0.06F), 0.03F);
    for (const float side : {-1.0F, 1.0F}) {
        head.add(ellipsoid({side * 0.065F, -0.075F, 0.565F}, {0.045F, 0.04F, 0.055F}), 0.03F);
        head.cut(ellipsoid({side * 0.035F, -0.115F, 0.585F}, {0.02F, 0.025F, 0.03F}), 0.012F);
    }
}

void addMouth(Shape& head) {
    head.add(ellipsoid({0, -0.235F, 0.44F}, {0.17F, 0.09F, 0.1F}), 0.08F);
    head.addPair(capsule({0.028F, -0.2F, 0.53F}, {0.125F, -0.232F, 0.47F}, 0.026F, 0.01F), 0.02F);
    head.addPair(capsule({0.0F, -0.268F, 0.525F}, {0.11F, -0.24F, 0.475F}, 0.032F, 0.01F), 0.02F);
    head.cut(capsule({-0.12F, -0.235F, 0.515F}, {0.12F, -0.235F, 0.515F}, 0.007F, 0.007F), 0.012F);
    head.cut(capsule({0, -0.125F, 0.575F}, {0, -0.165F, 0.555F}, 0.012F, 0.016F), 0.03F);
}

void addEars(Shape& head) {
    for (const float side : {-1.0F, 1.0F}) {
        const float x = side * 0.485F;
        head.add(
            ellipsoid({x, 0.05F, -0.06F}, {0.05F, 0.17F, 0.1F}).pointing({side * 0.25F, 1, -0.25F}),
            0.03F);
        head.cut(ellipsoid({side * 0.545F, 0.06F, -0.045F}, {0.035F, 0.11F, 0.055F})
                     .pointing({side * 0.25F, 1, -0.25F}),
                 0.02F);
        head.add(ball({side * 0.49F, 0.03F, 0.015F}, 0.028F), 0.02F);   // tragus
        head.add(ball({side * 0.475F, -0.1F, -0.01F}, 0.042F), 0.02F);  // lobe
    }
}

/// A tube through the points.
void addRidge(Shape& shape, std::span<const vec3> points, float radius, float blend) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        shape.add(capsule(points[i], points[i + 1], radius, radius), blend);
    }
}

}  // namespace

Shape hand(std::uint32_t seed) {
    Shape hand;
    hand.add(ellipsoid({0, -0.92F, -0.01F}, {0.2F, 0.3F, 0.13F}));           // wrist
    hand.add(box({0.01F, -0.32F, 0}, {0.33F, 0.36F, 0.105F}, 0.1F), 0.16F);  // palm
    hand.add(ellipsoid({0.2F, -0.48F, 0.09F}, {0.15F, 0.27F, 0.1F}).pointing({0.3F, 1, 0}), 0.08F);
    hand.add(ellipsoid({-0.21F, -0.46F, 0.07F}, {0.11F, 0.29F, 0.09F}), 0.08F);
    hand.cut(ellipsoid({-0.02F, -0.3F, 0.19F}, {0.14F, 0.2F, 0.1F}), 0.1F);          // hollow
    addFinger(hand, {{0.26F, 0.0F, 0.0F}, {0.16F, 1, 0.02F}, 0.66F, 0.088F});        // index
    addFinger(hand, {{0.09F, 0.04F, 0.0F}, {0.04F, 1, 0.03F}, 0.74F, 0.091F});       // middle
    addFinger(hand, {{-0.08F, 0.02F, 0.0F}, {-0.09F, 1, 0.03F}, 0.69F, 0.086F});     // ring
    addFinger(hand, {{-0.235F, -0.07F, 0.0F}, {-0.24F, 1, 0.02F}, 0.54F, 0.072F});   // little
    addFinger(hand, {{0.27F, -0.5F, 0.06F}, {0.72F, 0.75F, 0.15F}, 0.68F, 0.105F});  // thumb
    // Lines of the palm.
    hand.cut(capsule({0.22F, -0.13F, 0.115F}, {0.07F, -0.5F, 0.125F}, 0.012F, 0.012F), 0.025F);
    hand.cut(capsule({0.24F, -0.12F, 0.115F}, {-0.2F, -0.28F, 0.12F}, 0.011F, 0.011F), 0.025F);
    hand.cut(capsule({0.16F, -0.05F, 0.115F}, {-0.28F, -0.16F, 0.115F}, 0.011F, 0.011F), 0.025F);
    // Tendons on the back.
    for (const float x : {0.24F, 0.085F, -0.075F, -0.22F}) {
        hand.add(capsule({0.5F * x, -0.6F, -0.085F}, {x, -0.05F, -0.075F}, 0.022F, 0.03F), 0.06F);
    }
    hand.setRelief({Relief::Kind::Bumps, 0.003F, 22.0F, seed});
    return hand;
}

Shape head(std::uint32_t seed) {
    Shape head;
    head.add(ellipsoid({0, 0.34F, -0.1F}, {0.47F, 0.52F, 0.56F}));                // skull
    head.add(ellipsoid({0, 0.0F, 0.1F}, {0.385F, 0.5F, 0.4F}), 0.15F);            // face
    head.add(ellipsoid({0, 0.33F, 0.22F}, {0.37F, 0.22F, 0.27F}), 0.1F);          // forehead
    head.addPair(ellipsoid({0.24F, -0.02F, 0.32F}, {0.14F, 0.1F, 0.12F}), 0.1F);  // cheeks
    head.add(ellipsoid({0, -0.34F, 0.16F}, {0.28F, 0.18F, 0.28F}), 0.12F);        // jaw
    head.addPair(capsule({0.33F, -0.12F, 0.0F}, {0.16F, -0.43F, 0.3F}, 0.07F, 0.06F), 0.1F);
    head.add(ellipsoid({0, -0.435F, 0.4F}, {0.1F, 0.075F, 0.08F}), 0.08F);  // chin
    addEyes(head);
    addNose(head);
    addMouth(head);
    addEars(head);
    head.add(capsule({0, -0.3F, -0.1F}, {0, -0.85F, -0.16F}, 0.25F, 0.27F), 0.08F);  // neck
    head.addPair(capsule({0.27F, -0.15F, -0.1F}, {0.05F, -0.85F, 0.1F}, 0.06F, 0.05F), 0.08F);
    head.add(ball({0, -0.6F, 0.14F}, 0.05F), 0.06F);                       // larynx
    head.add(ellipsoid({0, -1.02F, -0.16F}, {0.6F, 0.2F, 0.32F}), 0.18F);  // shoulders
    head.cut(box({0, -1.26F, 0}, {1.2F, 0.2F, 1.2F}), 0.02F);
    head.setRelief({Relief::Kind::Bumps, 0.004F, 14.0F, seed});
    return head;
}

Shape hip(std::uint32_t seed) {
    Shape hip;
    // The wing of the ilium: a plate that bends, thick along its crest.
    hip.add(ellipsoid({-0.06F, 0.42F, -0.02F}, {0.6F, 0.5F, 0.09F}));
    hip.cut(ellipsoid({-0.02F, 0.5F, 0.33F}, {0.46F, 0.36F, 0.3F}), 0.1F);
    hip.cut(ellipsoid({-0.1F, 0.42F, -0.36F}, {0.5F, 0.36F, 0.31F}), 0.1F);
    constexpr vec3 kCrest[] = {{0.56F, 0.4F, 0.12F},    {0.5F, 0.62F, 0.08F},
                               {0.3F, 0.83F, 0.01F},    {0.02F, 0.93F, -0.05F},
                               {-0.28F, 0.87F, -0.06F}, {-0.53F, 0.67F, 0.0F},
                               {-0.65F, 0.42F, 0.08F},  {-0.56F, 0.22F, 0.08F}};
    addRidge(hip, kCrest, 0.062F, 0.015F);
    hip.add(ball({0.55F, 0.38F, 0.12F}, 0.08F), 0.06F);  // spines at its front
    hip.add(ball({0.42F, 0.12F, 0.1F}, 0.075F), 0.08F);
    hip.add(capsule({0.55F, 0.36F, 0.11F}, {0.38F, 0.08F, 0.08F}, 0.05F, 0.09F), 0.06F);
    hip.add(ellipsoid({-0.46F, 0.34F, 0.06F}, {0.17F, 0.2F, 0.09F}), 0.1F);  // joint of the sacrum
    hip.add(capsule({0.05F, 0.35F, 0}, {0.12F, -0.1F, 0.02F}, 0.13F, 0.22F), 0.12F);  // neck
    hip.add(ball({0.14F, -0.14F, 0.06F}, 0.29F), 0.08F);
    // Ischium, pubis and the ring that they close around the foramen.
    hip.add(capsule({0.02F, -0.26F, 0}, {-0.2F, -0.72F, 0.02F}, 0.17F, 0.14F), 0.1F);
    hip.add(ellipsoid({-0.2F, -0.8F, 0.03F}, {0.15F, 0.17F, 0.13F}), 0.06F);  // tuberosity
    hip.add(capsule({-0.16F, -0.3F, -0.06F}, {-0.33F, -0.36F, -0.12F}, 0.06F, 0.02F), 0.06F);
    hip.add(capsule({0.26F, -0.24F, 0}, {0.6F, -0.52F, 0.05F}, 0.13F, 0.09F), 0.08F);
    hip.add(ellipsoid({0.62F, -0.62F, 0.06F}, {0.09F, 0.16F, 0.08F}), 0.06F);  // symphysis
    hip.add(capsule({0.58F, -0.72F, 0.05F}, {-0.1F, -0.9F, 0.03F}, 0.075F, 0.085F), 0.06F);
    // The socket of the thigh, with its notch.
    hip.cut(ball({0.16F, -0.15F, 0.27F}, 0.215F), 0.03F);
    hip.cut(capsule({0.16F, -0.2F, 0.2F}, {0.2F, -0.46F, 0.32F}, 0.07F, 0.07F), 0.04F);
    hip.setRelief({Relief::Kind::Bumps, 0.008F, 8.0F, seed});
    return hip;
}

}  // namespace gfxrepro::scene::shapes
