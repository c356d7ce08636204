#include <cmath>

#include "runner/core/error.h"
#include "scenes/indoor/living_room_parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::living_room {

namespace {

using namespace indoor;
using Texture = Reflector::Texture;

constexpr float kPi = 3.14159265F;

constexpr glm::vec3 kChrome(0.42F, 0.43F, 0.45F), kCopper(0.55F, 0.27F, 0.15F),
    kBrass(0.52F, 0.38F, 0.15F), kBlack(0.03F, 0.03F, 0.035F);

class Collection {
  public:
    void add(const char* name, float reflectivity, const glm::vec3& color, MeshBuilder& builder,
             int triangles, Texture texture = Texture::None) {
        items_.push_back(
            {name, reflectivity, color, exactly(builder.take(name, 0), triangles), texture});
    }
    /// One turned part.
    void turn(const char* name, float reflectivity, const glm::vec3& color, const Outline& outline,
              int triangles, const glm::mat4& frame, Texture texture = Texture::None,
              float repeats = 1.0F) {
        MeshBuilder builder;
        addTurned(builder, outline, triangles, frame, repeats);
        add(name, reflectivity, color, builder, triangles, texture);
    }
    Reflector& last() { return items_.back(); }
    std::vector<Reflector> take() { return std::move(items_); }

  private:
    std::vector<Reflector> items_;
};

void addPlanar(Collection& all) {
    MeshBuilder builder;
    // Cells of 10 cm carry the shade beside the furniture.
    constexpr int kCellsX = 72;
    constexpr int kCellsZ = 58;
    const auto floor = [](float u, float v) {
        return glm::vec3(kHalfRoom.x * (2.0F * u - 1.0F), 0.0F, kHalfRoom.z * (1.0F - 2.0F * v));
    };
    addSheet(builder, floor, kCellsX, kCellsZ,
             {2.0F * kHalfRoom.x / 1.8F, 2.0F * kHalfRoom.z / 1.8F});
    all.add("floor", 0.35F, glm::vec3(1.0F), builder, 2 * kCellsX * kCellsZ, Texture::Planks);
    for (glm::vec3& normal : all.last().mesh.normals) normal = {0, 1, 0};
    for (std::size_t i = 0; i < all.last().mesh.positions.size(); ++i) {
        const glm::vec3& p = all.last().mesh.positions[i];
        all.last().mesh.colors[i] = glm::vec3(floorLightAt({p.x, p.z}));
    }
    addRoundedTop(builder, kHalfTable - 0.006F, 0.012F, 8, 0.0F, placed(kTable));
    all.add("coffee_table_top", 0.5F, {0.16F, 0.08F, 0.045F}, builder, 34);
    addRoundedTop(builder, glm::vec2(kSideTableRadius), kSideTableRadius, 12, 0.0F,
                  placed(kSideTable));
    all.add("side_table_top", 0.5F, {0.16F, 0.08F, 0.045F}, builder, 50);
    addRoundedTop(builder, kHalfSideboard + glm::vec2(0.0F, 0.01F), 0.01F, 4, 0.0F,
                  placed(kSideboard));
    all.add("sideboard_top", 0.45F, {0.16F, 0.08F, 0.045F}, builder, 18);
    addRectangle(builder, kMirror, {-kHalfMirror.x, 0, 0}, {0, kHalfMirror.y, 0});
    all.add("mirror", 0.95F, glm::vec3(0.6F), builder, 2);
    addRectangle(builder, kTelevision, {0, 0, kHalfTelevision.x}, {0, kHalfTelevision.y, 0});
    all.add("television", 0.3F, kBlack, builder, 2);
    for (const float side : {-1.0F, 1.0F}) {
        const glm::vec3 centre(kSideboard.x - kHalfSideboard.x - 0.004F, 0.32F,
                               kSideboard.z + 0.5F * side * kHalfSideboard.y);
        addRectangle(builder, centre, {0, 0, 0.5F * kHalfSideboard.y - 0.03F}, {0, 0.22F, 0});
        all.add(side < 0 ? "cabinet_pane_left" : "cabinet_pane_right", 0.55F, {0.10F, 0.02F, 0.02F},
                builder, 2);
    }
}

void addVases(Collection& all) {
    const Outline vase{{0, 0},           {0.17F, 0},     {0.17F, 0},      {0.20F, 0.03F},
                       {0.29F, 0.28F},   {0.35F, 0.56F}, {0.30F, 0.84F},  {0.16F, 1.02F},
                       {0.125F, 1.10F},  {0.15F, 1.18F}, {0.185F, 1.22F}, {0.185F, 1.225F},
                       {0.175F, 1.225F}, {0.14F, 1.18F}, {0.112F, 1.10F}, {0.145F, 1.02F},
                       {0.28F, 0.84F},   {0.33F, 0.56F}, {0.20F, 0.15F},  {0, 0.08F}};
    all.turn("vase", 0.6F, {0.05F, 0.13F, 0.30F}, vase, 14'000, placed(kVase));
    const Outline small{{0, 0},           {0.06F, 0},      {0.06F, 0},     {0.10F, 0.09F},
                        {0.085F, 0.17F},  {0.035F, 0.25F}, {0.03F, 0.31F}, {0.06F, 0.36F},
                        {0.055F, 0.362F}, {0.024F, 0.31F}, {0.03F, 0.25F}, {0.078F, 0.17F},
                        {0.08F, 0.09F},   {0, 0.03F}};
    all.turn("small_vase", 0.6F, {0.30F, 0.06F, 0.05F}, small, 4'000,
             placed(kSideboard + glm::vec3(0.0F, 0, -0.98F)));
    const Outline bowl{{0, 0},           {0.06F, 0},      {0.06F, 0},      {0.062F, 0.012F},
                       {0.13F, 0.045F},  {0.19F, 0.115F}, {0.192F, 0.12F}, {0.187F, 0.121F},
                       {0.125F, 0.053F}, {0.06F, 0.024F}, {0, 0.018F}};
    all.turn("bowl", 0.85F, kBrass, bowl, 5'000, placed(kTable + glm::vec3(0.40F, 0, 0.08F)));
    const Outline pot{{0, 0},           {0.17F, 0},      {0.17F, 0},      {0.24F, 0.12F},
                      {0.275F, 0.28F},  {0.25F, 0.44F},  {0.262F, 0.46F}, {0.255F, 0.475F},
                      {0.238F, 0.465F}, {0.228F, 0.44F}, {0.20F, 0.38F},  {0, 0.38F}};
    all.turn("pot_copper", 0.7F, kCopper, pot, 7'000, placed(kPots[0]));
    all.turn("pot_steel", 0.7F, kChrome, pot, 7'000, placed(kPots[1]));
}

void addTeapot(Collection& all) {
    constexpr float kSize = 0.105F;  // largest radius
    const glm::mat4 f = placed(kTable + glm::vec3(-0.22F, 0, -0.06F), 0.6F);
    const auto scaled = [](std::initializer_list<glm::vec2> points) {
        Outline outline;
        for (const glm::vec2& p : points) outline.push_back(p * kSize);
        return outline;
    };
    const auto station = [&](float x, float y, float r) {
        return MeshBuilder::Station{glm::vec3(f * glm::vec4(x * kSize, y * kSize, 0, 1)),
                                    r * kSize};
    };
    MeshBuilder builder;
    addTurned(builder,
              scaled({{0, 0},
                      {0.62F, 0},
                      {0.62F, 0},
                      {0.65F, 0.05F},
                      {0.90F, 0.30F},
                      {1.0F, 0.62F},
                      {0.90F, 0.98F},
                      {0.66F, 1.20F},
                      {0.66F, 1.20F},
                      {0.60F, 1.22F},
                      {0.56F, 1.19F},
                      {0.3F, 1.15F},
                      {0, 1.14F}}),
              6'400, f);
    addTurned(builder,
              scaled({{0.60F, 1.20F},
                      {0.58F, 1.25F},
                      {0.34F, 1.36F},
                      {0.12F, 1.42F},
                      {0.09F, 1.47F},
                      {0.16F, 1.55F},
                      {0.13F, 1.64F},
                      {0, 1.67F}}),
              2'200, f);
    const MeshBuilder::Station spout[] = {
        station(0.78F, 0.42F, 0.24F), station(1.12F, 0.58F, 0.18F), station(1.30F, 0.90F, 0.12F),
        station(1.42F, 1.16F, 0.09F), station(1.58F, 1.28F, 0.085F)};
    addBentTube(builder, spout, 34, 24);
    const MeshBuilder::Station handle[] = {
        station(-0.80F, 1.02F, 0.075F), station(-1.20F, 1.12F, 0.075F),
        station(-1.50F, 0.92F, 0.08F),  station(-1.42F, 0.58F, 0.075F),
        station(-1.12F, 0.36F, 0.07F),  station(-0.84F, 0.32F, 0.07F)};
    addBentTube(builder, handle, 44, 16);
    all.add("teapot", 0.8F, {0.50F, 0.48F, 0.42F}, builder, 12'000);
}

void addLamps(Collection& all) {
    MeshBuilder builder;
    // A foot on the floor, an arc over the sofa's end, the dish hanging from it.
    const Outline foot{{0, 0},          {0.17F, 0},     {0.17F, 0},     {0.17F, 0.025F},
                       {0.16F, 0.035F}, {0.03F, 0.05F}, {0.016F, 0.10F}};
    addTurned(builder, foot, 1'200, placed(kLampFoot));
    const glm::vec3 top = kLampShade + glm::vec3(0, 0.17F, 0);
    const glm::vec3 over = top - kLampFoot;
    const auto onArc = [&](float share, float y) {
        return MeshBuilder::Station{kLampFoot + glm::vec3(share * over.x, y, share * over.z),
                                    0.014F};
    };
    const MeshBuilder::Station arc[] = {
        onArc(0, 0.06F),     onArc(0.0F, 0.8F),   onArc(0.04F, 1.5F), onArc(0.22F, 2.02F),
        onArc(0.52F, 2.22F), onArc(0.85F, 2.16F), onArc(1.0F, 1.94F)};
    addBentTube(builder, arc, 84, 16);
    all.add("arc_lamp_stand", 0.9F, kChrome, builder, 4'000);
    const Outline dish{{0.235F, 0.0F},  {0.225F, 0.07F}, {0.17F, 0.14F},
                       {0.06F, 0.175F}, {0.0F, 0.18F},   {0.0F, 0.18F}};
    const Outline inside{{0, 0.165F},    {0.055F, 0.162F}, {0.16F, 0.13F}, {0.213F, 0.065F},
                         {0.225F, 0.0F}, {0.225F, 0.0F},   {0.235F, 0.0F}};
    const auto addDish = [&](const glm::vec3& place, float scale, int triangles) {
        // Inside from its top down to the rim, round it, and up outside: outlines turn the right
        // hand out when going up, so the inside is walked downwards.
        Outline both;
        for (const glm::vec2& p : inside) both.push_back(p * scale);
        for (const glm::vec2& p : dish) both.push_back(p * scale);
        both.pop_back();
        addTurned(builder, both, triangles, placed(place));
    };
    addDish(kLampShade, 1.0F, 8'000);
    all.add("arc_lamp_dish", 0.9F, kChrome, builder, 8'000);
    addDish(kCeilingLamp, 1.5F, 6'700);
    all.add("ceiling_lamp", 0.9F, kBrass, builder, 7'000);
    const Outline table{{0, 0},          {0.09F, 0},      {0.09F, 0},      {0.09F, 0.012F},
                        {0.03F, 0.03F},  {0.05F, 0.10F},  {0.085F, 0.17F}, {0.05F, 0.25F},
                        {0.015F, 0.30F}, {0.015F, 0.46F}, {0, 0.465F}};
    all.turn("table_lamp_foot", 0.9F, kChrome, table, 3'000,
             placed(kSideboard + glm::vec3(0, 0, 0.98F)));
    const Outline candlestick{{0, 0},          {0.055F, 0},     {0.055F, 0},      {0.05F, 0.012F},
                              {0.015F, 0.03F}, {0.012F, 0.06F}, {0.028F, 0.085F}, {0.012F, 0.11F},
                              {0.014F, 0.17F}, {0.032F, 0.19F}, {0.032F, 0.20F},  {0.012F, 0.20F},
                              {0, 0.20F}};
    all.turn("candlestick_left", 0.9F, kBrass, candlestick, 3'000,
             placed(kTable + glm::vec3(0.12F, 0, 0.22F)));
    all.turn("candlestick_right", 0.9F, kBrass, candlestick, 3'000,
             placed(kTable + glm::vec3(0.06F, 0, -0.24F)));
}

/// A sphere on a foot, open towards −x: chrome out- and inside.
void addBallChair(Collection& all) {
    MeshBuilder builder;
    const Outline foot{{0, 0},         {0.34F, 0},     {0.34F, 0},    {0.33F, 0.015F},
                       {0.12F, 0.05F}, {0.07F, 0.12F}, {0.09F, 0.20F}};
    addTurned(builder, foot, 2'000, placed(kBallChair));
    Outline shell;
    constexpr int kArc = 16;
    constexpr float kOpenRad = 2.22F;
    for (const float radius : {0.56F, 0.535F}) {
        for (int k = 0; k <= kArc; ++k) {
            const int j = radius > 0.55F ? k : kArc - k;
            const float angleRad = kOpenRad * static_cast<float>(j) / kArc;
            shell.emplace_back(j == 0 ? 0.0F : radius * sdf::sine(angleRad),
                               -radius * sdf::cosine(angleRad));
        }
    }
    addTurned(builder, shell, 12'000,
              placedAlong(kBallChair + glm::vec3(0, 0.72F, 0), {-1.0F, 0.16F, 0.12F}));
    all.add("ball_chair", 0.7F, kChrome, builder, 14'000);
}

/// A torus knot (2, 3) of polished bronze, on its pedestal.
void addKnot(Collection& all, int triangles) {
    constexpr int kSides = 36;
    const int length = triangles / (2 * kSides);
    MeshBuilder builder;
    const auto centreAt = [](float u) {
        const float a = 2.0F * kPi * u;
        const float r = 0.17F + 0.075F * sdf::cosine(3.0F * a);
        return glm::vec3(r * sdf::cosine(2.0F * a), 0.34F + r * sdf::sine(2.0F * a),
                         0.085F * sdf::sine(3.0F * a));
    };
    const auto at = [&](float u, float v) {
        // The frame is taken from the middle of the knot, which no tangent meets: it closes.
        const glm::vec3 c = centreAt(u);
        const glm::vec3 t = glm::normalize(centreAt(u + 0.002F) - centreAt(u - 0.002F));
        const glm::vec3 out = c - glm::vec3(0, 0.34F, 0);
        const glm::vec3 x = glm::normalize(out - t * glm::dot(out, t));
        const glm::vec3 y = glm::cross(x, t);
        const float a = v == 1.0F ? 0.0F : 2.0F * kPi * v;
        return kPedestal + c + 0.062F * (x * sdf::cosine(a) + y * sdf::sine(a));
    };
    // u wraps too: its last column repeats the first.
    const auto closed = [&](float u, float v) { return at(u == 1.0F ? 0.0F : u, v); };
    addSheet(builder, closed, length, kSides);
    all.add("knot", 0.8F, kCopper, builder, triangles);
}

}  // namespace

std::vector<Reflector> reflectors() {
    Collection all;
    addPlanar(all);
    addVases(all);
    addTeapot(all);
    addLamps(all);
    addBallChair(all);
    Outline ball;
    for (int k = 0; k <= 16; ++k) {
        const float angleRad = kPi * static_cast<float>(k) / 16.0F;
        ball.emplace_back(k % 16 == 0 ? 0.0F : kBall.y * sdf::sine(angleRad),
                          -kBall.y * sdf::cosine(angleRad));
    }
    all.turn("ball", 0.9F, kChrome, ball, 8'000, placed(kBall));
    const float h = kRoomHeightM;
    const Outline column{{0.27F, 0},          {0.27F, 0.10F},      {0.27F, 0.10F},
                         {0.25F, 0.10F},      {0.25F, 0.10F},      {0.262F, 0.125F},
                         {0.25F, 0.15F},      {0.25F, 0.15F},      {0.22F, 0.17F},
                         {0.20F, 0.22F},      {0.20F, 0.22F},      {0.195F, h - 0.30F},
                         {0.195F, h - 0.30F}, {0.215F, h - 0.27F}, {0.195F, h - 0.24F},
                         {0.195F, h - 0.24F}, {0.25F, h - 0.12F},  {0.25F, h - 0.12F},
                         {0.27F, h - 0.12F},  {0.27F, h - 0.12F},  {0.27F, h}};
    all.turn("column_west", 0.4F, glm::vec3(1.0F), column, 4'000, placed(kColumns[0]),
             Texture::Marble, 2.0F);
    all.turn("column_east", 0.4F, glm::vec3(1.0F), column, 4'000, placed(kColumns[1]),
             Texture::Marble, 2.0F);
    addKnot(all, 14'538);
    return all.take();
}

}  // namespace gfxrepro::scene::living_room
