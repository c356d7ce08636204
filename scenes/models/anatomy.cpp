// Stand-ins for scanned parts of the body: hand, head, hip bone.
#include <cstddef>
#include <span>

#include "scenes/models/shapes.h"

namespace gfxrepro::scene::shapes {

using glm::vec3;
using sdf::ball;
using sdf::box;
using sdf::capsule;
using sdf::ellipsoid;
using sdf::Relief;
using sdf::Shape;

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
