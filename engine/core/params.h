// Parameters, which are keys that are declared as they are read (key_info.h): that one call checks
// the value, marks it read, fills the manifest and feeds `gfxrepro describe`.
#pragma once

#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/key_info.h"
#include "engine/core/node.h"

namespace gfxrepro {

/// What a declaration says beside the name and the default.
struct ParamSpec {
    std::string_view doc;
    std::string_view unit = "";
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
};

/// A value of an enumeration and its spelling in configs.
template <class E>
struct Choice {
    E value;
    std::string_view name;
    std::string_view doc = "";
};

/// A map of values that are read by declaration. Errors carry the value's file:line:column.
///
///     int resolution = params.getInt("resolution", 256, {"voxels along each axis", "voxels", 8,
///     1024}); Method method = params.getEnum("method", Method::Worksheet, kMethods, {"what is
///     measured"}); params.finish();
class Params {
  public:
    /// `values` is a map or null. `owner` names the reader in messages ("technique
    /// 'marching'").
    Params(Node values, std::string owner);

    /// Values that take the place of declared defaults. They count as not given: a parameter that
    /// nothing reads is not refused for them.
    void offer(Node defaults) { offered_ = std::move(defaults); }

    int getInt(std::string_view name, int fallback, const ParamSpec& spec);
    double getDouble(std::string_view name, double fallback, const ParamSpec& spec);
    bool getBool(std::string_view name, bool fallback, const ParamSpec& spec);
    std::string getText(std::string_view name, std::string_view fallback, const ParamSpec& spec);
    /// A list of exactly fallback.size() numbers; the range holds for each.
    std::vector<double> getVector(std::string_view name, std::span<const double> fallback,
                                  const ParamSpec& spec);
    /// As getVector, but the entry may be absent or null.
    std::optional<std::vector<double>> getOptionalVector(std::string_view name, std::size_t count,
                                                         const ParamSpec& spec);

    template <class E, std::size_t N>
    E getEnum(std::string_view name, E fallback, const Choice<E> (&choices)[N],
              const ParamSpec& spec) {
        std::string_view names[N];
        std::string_view docs[N];
        std::size_t fallbackIndex = N;
        for (std::size_t i = 0; i < N; ++i) {
            names[i] = choices[i].name;
            docs[i] = choices[i].doc;
            if (choices[i].value == fallback) fallbackIndex = i;
        }
        return choices[getChoice(name, fallbackIndex, names, docs, spec)].value;
    }

    /// The place of a value that was given, else of the whole map: for checks across parameters.
    SourceLocation locationOf(std::string_view name) const;
    bool isGiven(std::string_view name) const;
    /// Throws Error ("'NAME' needs NEEDS") at the first of `names` that is given: for parameters
    /// that nothing reads under the choice that was made. None is ignored.
    void refuseGiven(std::initializer_list<std::string_view> names, std::string_view needs) const;

    /// Throws Error at the first key that nobody declared, with the nearest declared name.
    void finish() const;
    /// For those who only ask what a reader declares and whether it takes the values: finish() ends
    /// the reader by throwing Finished.
    struct Finished {};
    void stopWhenFinished() { stopsWhenFinished_ = true; }

    /// Every declared parameter with the value that is in force, in order of declaration.
    const Node& resolved() const { return resolved_; }
    /// Every declared parameter, in order of declaration.
    const std::vector<KeyInfo>& declared() const { return declared_; }

  private:
    std::size_t getChoice(std::string_view name, std::size_t fallback,
                          std::span<const std::string_view> names,
                          std::span<const std::string_view> docs, const ParamSpec& spec);
    GivenKey declare(std::string_view name, std::string type, const Node& fallback,
                     const ParamSpec& spec, std::size_t count = 0);

    Node values_;
    Node offered_ = Node::map({});
    std::string owner_;
    Node resolved_;
    std::vector<KeyInfo> declared_;
    bool stopsWhenFinished_ = false;
};

}  // namespace gfxrepro
