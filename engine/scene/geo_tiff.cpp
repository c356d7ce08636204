// Keys and codes of OGC GeoTIFF 1.1; the items of GDAL's metadata.
#include "engine/scene/geo_tiff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/text.h"

namespace gfxrepro::scene {
namespace {

constexpr std::uint16_t kModelType = 1024, kGeographic = 2;
constexpr std::uint16_t kAngularUnit = 2054, kDegree = 9102, kDegreeOfSupplier = 9122;
constexpr std::uint16_t kLinearUnit = 3076, kLinearUnitSize = 3077, kVerticalUnit = 4099;
constexpr std::uint16_t kUserDefined = 32767, kDoubleParams = 34736;

struct LengthUnit {
    std::uint16_t code;  // of EPSG
    double metres;
};
constexpr LengthUnit kLengthUnits[] = {
    {9001, 1.0}, {9002, 0.3048}, {9003, 1200.0 / 3937.0}, {9036, 1000.0}};

/// Of a key, count times: key, tag that holds its values (0: it is the value), count, value.
class Keys {
  public:
    Keys(const GeoTags& tags, const std::string& file) : tags_(tags), file_(file) {}

    std::optional<std::uint16_t> find(std::uint16_t key, std::uint16_t tag = 0) const {
        const std::vector<std::uint16_t>& keys = tags_.keys;
        for (std::size_t i = 4; i + 3 < keys.size(); i += 4) {
            if (keys[i] == key && keys[i + 1] == tag) return keys[i + 3];
        }
        return std::nullopt;
    }

    /// Metres where the file does not say its unit.
    double metresOf(std::uint16_t key) const {
        const std::uint16_t code = find(key).value_or(0);
        if (code == 0) return 1.0;
        for (const LengthUnit& unit : kLengthUnits) {
            if (unit.code == code) return unit.metres;
        }
        if (key == kLinearUnit && code == kUserDefined) {
            const auto at = find(kLinearUnitSize, kDoubleParams);
            const double size = at && *at < tags_.keyDoubles.size() ? tags_.keyDoubles[*at] : 0.0;
            if (size > 0.0 && std::isfinite(size)) return size;
        }
        throw Error(
            fmt::format("{}: the {} unit is {}; allowed: 9001 (metre), 9002 (foot), 9003 "
                        "(US survey foot), 9036 (kilometre)",
                        file_, key == kLinearUnit ? "linear" : "vertical", code));
    }

    /// Along a meridian: degrees of longitude are shorter.
    double metresOfDegrees() const {
        const std::uint16_t code = find(kAngularUnit).value_or(0);
        const bool isDegree = code == 0 || code == kDegree || code == kDegreeOfSupplier;
        if (isDegree) return kMetresPerDegree;
        throw Error(fmt::format("{}: the angular unit is {}; allowed: 9102 (degree)", file_, code));
    }

  private:
    const GeoTags& tags_;
    const std::string& file_;
};

/// The text of the item with this role; empty where there is none.
std::string itemOf(const std::string& metadata, std::string_view role) {
    const std::size_t at = metadata.find(fmt::format("role=\"{}\"", role));
    const std::size_t begin = at == metadata.npos ? at : metadata.find('>', at);
    if (begin == metadata.npos) return "";
    return std::string(trimmed(metadata.substr(begin + 1, metadata.find('<', begin) - begin - 1)));
}

/// Metres of the unit of heights.
double heightUnitM(const GeoTags& tags, const Keys& keys, const std::string& file) {
    const std::string unit = itemOf(tags.metadata, "unittype");
    if (unit.empty()) return keys.metresOf(kVerticalUnit);
    for (const std::string_view metre : {"m", "metre", "metres", "meter", "meters"}) {
        if (unit == metre) return 1.0;
    }
    for (const std::string_view foot : {"ft", "foot", "feet"}) {
        if (unit == foot) return 0.3048;
    }
    for (const std::string_view foot : {"us-ft", "ftUS", "US survey foot"}) {
        if (unit == foot) return 1200.0 / 3937.0;
    }
    throw Error(fmt::format("{}: its heights are in '{}'; allowed: m, ft, us-ft", file, unit));
}

/// What the model makes of a value, by the scale of z and where it begins: a factor and what is
/// added to it. A scale of 0 is none.
glm::dvec2 verticalOf(const GeoTags& tags, const std::string& file) {
    const std::vector<double>&m = tags.transform, &t = tags.tiepoint;
    const bool isMatrix = tags.pixelScale.empty() && m.size() >= 12;
    const double scale = isMatrix ? m[10] : tags.pixelScale.size() >= 3 ? tags.pixelScale[2] : 0.0;
    const double offset = isMatrix ? m[11] : t.size() == 6 ? t[5] - t[2] * scale : 0.0;
    if (isMatrix && (m[8] != 0.0 || m[9] != 0.0)) {
        throw Error(file + ": its ModelTransformation tilts its heights; allowed: level ones");
    }
    if (scale == 0.0 && offset != 0.0) {
        throw Error(
            fmt::format("{}: z begins at {:g}, where its scale is 0; allowed: another scale, or 0",
                        file, offset));
    }
    return scale == 0.0 ? glm::dvec2(1.0, 0.0) : glm::dvec2(scale, offset);
}

/// How far samples stand apart along x and y, in units of the model; none where the file does not
/// say it.
std::optional<glm::dvec2> stepOf(const GeoTags& tags, bool isGeographic, const std::string& file) {
    double x = 0.0, y = 0.0, skew = 0.0;
    bool isMirrored = false;  // rows go down: south
    if (tags.pixelScale.size() >= 2) {
        x = std::abs(tags.pixelScale[0]);
        y = std::abs(tags.pixelScale[1]);
        isMirrored = tags.pixelScale[0] * tags.pixelScale[1] < 0.0;
    } else if (tags.transform.size() >= 6) {
        const std::vector<double>& m = tags.transform;
        x = std::hypot(m[0], m[4]);
        y = std::hypot(m[1], m[5]);
        skew = std::abs(m[0] * m[1] + m[4] * m[5]);
        isMirrored = m[0] * m[5] - m[1] * m[4] > 0.0;
    }
    if (isMirrored) {
        throw Error(file + ": its rows go north; allowed: from west to east and north to south");
    }
    if (!(y > 0.0) || !std::isfinite(y)) return std::nullopt;
    constexpr double kRounding = 1e-3;
    if (!isGeographic && (std::abs(x - y) > kRounding * y || skew > kRounding * y * y)) {
        throw Error(
            fmt::format("{}: its samples stand {:g} apart along x and {:g} along y{}; "
                        "allowed: the same, on squares",
                        file, x, y, skew > kRounding * y * y ? ", askew" : ""));
    }
    return glm::dvec2(x, y);
}

/// Of the middle of a geographic map; 0 where the file does not say where it lies.
double latitudeDeg(const GeoTags& tags, double step) {
    const glm::dvec2 middle = 0.5 * glm::dvec2(tags.sizeSamples);
    const std::vector<double>&m = tags.transform, &t = tags.tiepoint;
    if (t.size() >= 6) return t[4] - (middle.y - t[1]) * step;
    return m.size() >= 8 ? m[4] * middle.x + m[5] * middle.y + m[7] : 0.0;
}

}  // namespace

std::optional<float> floatIn(const std::string& text) {
    char* end = nullptr;
    const float value = std::strtof(text.c_str(), &end);
    return end != text.c_str() ? std::optional(value) : std::nullopt;
}

GeoUnits unitsOf(const GeoTags& tags, const std::string& file) {
    const Keys keys(tags, file);
    GeoUnits units;
    const auto scale = floatIn(itemOf(tags.metadata, "scale"));
    const auto offset = floatIn(itemOf(tags.metadata, "offset"));
    const glm::vec2 ofModel(verticalOf(tags, file));  // GDAL writes both, and both alike
    const bool isGiven = scale || offset;
    const glm::vec2 given =
        isGiven ? glm::vec2(scale.value_or(1.0F), offset.value_or(0.0F)) : ofModel;
    if (isGiven && given != ofModel && ofModel != glm::vec2(1.0F, 0.0F)) {
        throw Error(fmt::format(
            "{}: scale {} and offset {} of its metadata, {} and {} of its model's z; allowed: the "
            "same, or of one alone",
            file, given.x, given.y, ofModel.x, ofModel.y));
    }
    units.scale = given.x;
    units.offset = given.y;
    if (!std::isfinite(units.scale) || !std::isfinite(units.offset)) {
        throw Error(fmt::format("{}: scale {} and offset {}; finite numbers are allowed", file,
                                units.scale, units.offset));
    }
    const double heightM = heightUnitM(tags, keys, file);
    units.scale = static_cast<float>(units.scale * heightM);
    units.offset = static_cast<float>(units.offset * heightM);
    const bool isGeographic = keys.find(kModelType) == kGeographic;
    if (const std::optional<glm::dvec2> step = stepOf(tags, isGeographic, file)) {
        const double unitM = isGeographic ? keys.metresOfDegrees() : keys.metresOf(kLinearUnit);
        if (isGeographic) {
            const double east = std::cos(glm::radians(latitudeDeg(tags, step->y)));
            units.warning = unevenSpacing(step->x * unitM * east, step->y * unitM);
        }
        const auto spacing = static_cast<float>(step->y * unitM);
        if (spacing > 0.0F && std::isfinite(spacing)) units.spacingM = spacing;
    }
    return units;
}

std::string unevenSpacing(double eastM, double northM) {
    if (std::abs(eastM - northM) < 0.01 * northM) return "";
    return fmt::format(
        "its samples stand {:.4g} m apart from west to east in its middle and {:.4g} m from north "
        "to south; both are drawn {:.4g} m apart",
        eastM, northM, northM);
}

}  // namespace gfxrepro::scene
