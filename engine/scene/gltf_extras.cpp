#include "engine/scene/gltf_extras.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "engine/scene/load.h"

namespace gfxrepro::scene::gltf {
namespace {

using Value = tinygltf::Value;

constexpr const char* kPaths = "camera_paths";
constexpr const char* kMotion = "motion";

Value numbersOf(const glm::dvec3& vector) {
    return Value(Value::Array{Value(vector.x), Value(vector.y), Value(vector.z)});
}

/// No value where it is no object, or has none of that name.
const Value& memberOf(const Value& object, const char* key) {
    static const Value none;
    return object.IsObject() ? object.Get(key) : none;
}

/// The members of an object; whether all that were asked for are there, numbers of a usual size.
class Members {
  public:
    explicit Members(const Value& object) : object_(object) {}

    double number(const char* key) { return numberOf(memberOf(object_, key)); }
    float floatNumber(const char* key) { return static_cast<float>(number(key)); }
    glm::dvec3 vector(const char* key) {
        const Value& value = memberOf(object_, key);
        areSound_ = areSound_ && value.IsArray() && value.ArrayLen() == 3;
        if (!areSound_) return {};
        return {numberOf(value.Get(0)), numberOf(value.Get(1)), numberOf(value.Get(2))};
    }
    bool areSound() const { return areSound_; }

  private:
    double numberOf(const Value& value) {
        const double number = value.IsNumber() ? value.GetNumberAsDouble() : NAN;
        areSound_ = areSound_ && std::abs(number) <= double{kMaxCoordinate};
        return number;
    }

    const Value& object_;
    bool areSound_ = true;
};

std::optional<Camera> keyIn(const Value& object, const glm::dvec3& offset) {
    Members members(object);
    Camera key;
    key.position = members.vector("position") - offset;
    key.target = members.vector("target") - offset;
    key.up = members.vector("up");
    key.verticalFovRad = members.floatNumber("yfov");
    key.nearM = members.floatNumber("znear");
    key.farM = members.floatNumber("zfar");
    const bool isSound = members.areSound() && key.verticalFovRad > 0.0F &&
                         double{key.verticalFovRad} < std::numbers::pi && key.nearM > 0.0F &&
                         key.farM > key.nearM && key.position != key.target &&
                         key.up != glm::vec3(0.0F);
    return isSound ? std::optional(key) : std::nullopt;
}

std::optional<CameraPath> pathIn(const Value& object, const glm::dvec3& offset) {
    const Value &name = memberOf(object, "name"), &keys = memberOf(object, "keys");
    if (!name.IsString() || !keys.IsArray() || keys.ArrayLen() == 0) return std::nullopt;
    CameraPath path{name.Get<std::string>(), {}};
    for (std::size_t i = 0; i < keys.ArrayLen(); ++i) {
        const std::optional<Camera> key = keyIn(keys.Get(static_cast<int>(i)), offset);
        if (!key) return std::nullopt;
        path.keys.push_back(*key);
    }
    return path;
}

}  // namespace

Value numberExtra(const char* key, double value) {
    return Value(Value::Object{{key, Value(value)}});
}

std::optional<double> lengthExtra(const Value& extras, const char* key) {
    Members members(extras);
    const double length = members.number(key);
    return members.areSound() && length > 0.0 ? std::optional(length) : std::nullopt;
}

Value pathsExtra(const std::vector<CameraPath>& paths, const glm::dvec3& offset) {
    Value::Array all;
    for (const CameraPath& path : paths) {
        Value::Array keys;
        for (const Camera& key : path.keys) {
            keys.emplace_back(
                Value::Object{{"position", numbersOf(glm::dvec3(key.position) + offset)},
                              {"target", numbersOf(glm::dvec3(key.target) + offset)},
                              {"up", numbersOf(key.up)},
                              {"yfov", Value(double{key.verticalFovRad})},
                              {"znear", Value(double{key.nearM})},
                              {"zfar", Value(double{key.farM})}});
        }
        all.emplace_back(Value::Object{{"name", Value(path.name)}, {"keys", Value(keys)}});
    }
    return Value(Value::Object{{kPaths, Value(all)}});
}

std::vector<CameraPath> pathsIn(const Value& extras, const glm::dvec3& offset, LeftOut& leftOut) {
    std::vector<CameraPath> paths;
    const Value& all = memberOf(extras, kPaths);
    for (std::size_t i = 0; all.IsArray() && i < all.ArrayLen(); ++i) {
        std::optional<CameraPath> path = pathIn(all.Get(static_cast<int>(i)), offset);
        leftOut.add("a camera path among extras that cannot be read", path ? 0 : 1);
        if (path) paths.push_back(*std::move(path));
    }
    return paths;
}

Value motionExtra(const Motion& motion, const glm::dvec3& offset) {
    return Value(Value::Object{
        {kMotion, Value(Value::Object{{"pivot", numbersOf(glm::dvec3(motion.pivot) + offset)},
                                      {"axis", numbersOf(motion.axis)},
                                      {"turn_rad", Value(double{motion.turnRad})},
                                      {"swing", numbersOf(motion.swing)},
                                      {"swing_count", Value(double{motion.swingCount})}})}});
}

std::optional<Motion> motionIn(const Value& extras, const glm::dvec3& offset, LeftOut& leftOut) {
    const Value& object = memberOf(extras, kMotion);
    if (!object.IsObject()) return std::nullopt;
    Members members(object);
    Motion motion;
    motion.pivot = members.vector("pivot") - offset;
    motion.axis = members.vector("axis");
    motion.turnRad = members.floatNumber("turn_rad");
    motion.swing = members.vector("swing");
    motion.swingCount = members.floatNumber("swing_count");
    const bool isSound = members.areSound() && motion.axis != glm::vec3(0.0F);
    leftOut.add("a motion among extras that cannot be read", isSound ? 0 : 1);
    return isSound ? std::optional(motion) : std::nullopt;
}

}  // namespace gfxrepro::scene::gltf
