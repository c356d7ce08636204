// Keys and codes of OGC GeoTIFF 1.1; the items of GDAL's metadata.
#include "engine/scene/geo_tiff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "engine/scene/height_map.h"

namespace gfxrepro::scene {
namespace {

constexpr std::uint16_t kModelType = 1024, kProjectedModel = 1, kGeographic = 2;
constexpr std::uint16_t kAngularUnit = 2054, kDegree = 9102, kDegreeOfSupplier = 9122;
constexpr std::uint16_t kProjected = 3072, kVertical = 4096;
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

/// The value of an attribute of a tag, `<Item name="SCALE" role='scale'`; empty without it.
std::string_view attributeOf(std::string_view tag, std::string_view name) {
    for (std::size_t at = tag.find(name); at != tag.npos; at = tag.find(name, at + 1)) {
        const std::string_view behind = trimmed(tag.substr(at + name.size()));
        const bool isWord = at > 0 && std::isspace(static_cast<unsigned char>(tag[at - 1])) != 0;
        if (!isWord || !behind.starts_with('=')) continue;
        const std::string_view value = trimmed(behind.substr(1));
        if (value.empty() || (value[0] != '"' && value[0] != '\'')) continue;
        return value.substr(1, value.find(value[0], 1) - 1);
    }
    return {};
}

/// The text of the item with this role that is of the first sample; empty where there is none.
std::string itemOf(std::string_view metadata, std::string_view role) {
    constexpr std::string_view kComment = "<!--", kCommentEnd = "-->";
    while (!metadata.empty()) {
        metadata.remove_prefix(std::min(metadata.find('<'), metadata.size()));
        const bool isComment = metadata.starts_with(kComment);
        const std::size_t end = isComment ? metadata.find(kCommentEnd) : metadata.find('>');
        if (end == metadata.npos) return "";
        const std::string_view tag = metadata.substr(0, end);
        metadata.remove_prefix(end + 1);
        if (isComment || attributeOf(tag, "role") != role) continue;
        const std::string_view sample = attributeOf(tag, "sample");
        if (sample.empty() || sample == "0") {
            return std::string(trimmed(metadata.substr(0, metadata.find('<'))));
        }
    }
    return "";
}

bool isOneOf(std::uint16_t code, std::initializer_list<std::pair<int, int>> ranges) {
    return std::ranges::any_of(
        ranges, [&](const auto& range) { return code >= range.first && code <= range.second; });
}

/// What to say of a projected system that may have another unit than metres, where the file does
/// not say its unit itself. Known are EPSG's codes for UTM of ETRS89, NAD83 and WGS 84, Lambert of
/// Europe and France, and Mercator of the world.
std::string takenAsMetres(const Keys& keys) {
    const std::uint16_t code = keys.find(kProjected).value_or(kUserDefined);
    const bool isKnown = isOneOf(code, {{kUserDefined, kUserDefined},
                                        {25828, 25838},
                                        {26901, 26923},
                                        {32601, 32660},
                                        {32701, 32760},
                                        {3034, 3035},
                                        {2154, 2154},
                                        {3395, 3395},
                                        {3857, 3857}});
    if (keys.find(kLinearUnit) || isKnown) return "";
    return fmt::format("its coordinates, of EPSG {} and without a unit, are taken as metres", code);
}

/// What to say of other coordinates than those of maps, such as geocentric ones (3).
std::string takenAsOfAMap(const Keys& keys) {
    const std::uint16_t model = keys.find(kModelType).value_or(kProjectedModel);
    if (model == kProjectedModel) return "";
    return fmt::format("its coordinates, of model type {}, are taken as those of a map", model);
}

/// Likewise of heights: above the ellipsoid, EGM96, EGM2008, mean seas, Newlyn, NAVD88, EVRF.
std::string heightsTakenAsMetres(const GeoTags& tags, const Keys& keys) {
    const std::uint16_t code = keys.find(kVertical).value_or(kUserDefined);
    const bool isKnown = isOneOf(code, {{kUserDefined, kUserDefined},
                                        {5030, 5030},
                                        {5773, 5773},
                                        {3855, 3855},
                                        {5714, 5714},
                                        {5701, 5701},
                                        {5703, 5703},
                                        {5621, 5621},
                                        {5730, 5730}});
    if (keys.find(kVerticalUnit) || isKnown || !itemOf(tags.metadata, "unittype").empty()) {
        return "";
    }
    return fmt::format("its heights, of EPSG {} and without a unit, are taken as metres", code);
}

/// Metres of the unit of heights.
double heightUnitM(const GeoTags& tags, const Keys& keys, const std::string& file) {
    const std::string written = itemOf(tags.metadata, "unittype"), unit = lowerCase(written);
    if (unit.empty()) return keys.metresOf(kVerticalUnit);
    for (const std::string_view metre : {"m", "metre", "metres", "meter", "meters"}) {
        if (unit == metre) return 1.0;
    }
    for (const std::string_view foot : {"ft", "foot", "feet"}) {
        if (unit == foot) return 0.3048;
    }
    for (const std::string_view foot : {"us-ft", "ftus", "us survey foot"}) {
        if (unit == foot) return 1200.0 / 3937.0;
    }
    throw Error(fmt::format("{}: its heights are in '{}'; allowed: m, ft, us-ft", file, written));
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

/// Where the next column and the next row stand, in units of the model: x is east, y north.
struct Steps {
    glm::dvec2 column, row;
};

/// None where the file does not say it, or where nobody asks.
std::optional<Steps> stepsOf(const GeoTags& tags, bool isAsked, const std::string& file) {
    Steps steps{{1.0, 0.0}, {0.0, -1.0}};
    const std::vector<double>&scale = tags.pixelScale, &m = tags.transform;
    const bool isSaid = scale.size() >= 2 || m.size() >= 6;
    if (scale.size() >= 2) {
        steps = {{scale[0], 0.0}, {0.0, -scale[1]}};
    } else if (isSaid) {
        steps = {{m[0], m[4]}, {m[1], m[5]}};
    }
    const double right = steps.column.x, up = steps.row.y;
    if (right * up - steps.row.x * steps.column.y > 0.0) {
        const char* found = up > 0.0      ? "its rows go north"
                            : right < 0.0 ? "its columns go west"
                                          : "it is mirrored";
        throw Error(
            fmt::format("{}: {}; allowed: from west to east and north to south", file, found));
    }
    const double area = glm::length(steps.column) * glm::length(steps.row);
    if (!isAsked || !isSaid || !(area > 0.0) || !std::isfinite(area)) return std::nullopt;
    return steps;
}

/// Of the steps on the ground, or on its map. Throws Error where they are askew.
glm::dvec2 lengthsOf(const Steps& steps, const std::string& file) {
    const glm::dvec2 lengths(std::hypot(steps.column.x, steps.column.y),
                             std::hypot(steps.row.x, steps.row.y));
    constexpr double kRounding = 1e-3;
    if (std::abs(glm::dot(steps.column, steps.row)) > kRounding * lengths.x * lengths.y) {
        throw Error(file + ": its rows and columns are askew; allowed: at right angles");
    }
    return lengths;
}

/// How far north the middle of a map lies, in units of the model; none where the file does not say
/// where it lies.
std::optional<double> northOfMiddle(const GeoTags& tags, const Steps& steps) {
    const glm::dvec2 middle = 0.5 * glm::dvec2(tags.sizeSamples);
    const std::vector<double>&m = tags.transform, &t = tags.tiepoint;
    if (t.size() >= 6) return t[4] - (middle.y - t[1]) * glm::length(steps.row);
    if (m.size() >= 8) return m[4] * middle.x + m[5] * middle.y + m[7];
    return std::nullopt;
}

constexpr double kEarthRadiusM = 6378137.0;  // of WGS 84, at the equator

/// Of coordinates that do not say where they lie.
std::string takenAsAtTheEquator(const char* coordinates, glm::vec2 spacingM) {
    return fmt::format(
        "its coordinates, {}, do not say how far north it lies: its samples are drawn {} apart, as "
        "at the equator",
        coordinates, metresText(spacingM));
}

/// Spacing of Mercator's projection, which stretches both directions alike; the ellipsoid's
/// differs by less than 1 %.
void useMercator(std::optional<double> northM, glm::dvec2 mapM, GeoUnits& units) {
    const double stretch = std::cosh(northM.value_or(0.0) / kEarthRadiusM);
    units.spacingM = glm::vec2(mapM / stretch);
    const std::string drawn = metresText(*units.spacingM);
    if (!northM) {
        units.warning = takenAsAtTheEquator("of Mercator's projection", *units.spacingM);
    } else if (stretch > 1.01) {
        units.warning = fmt::format(
            "its samples stand {} apart on its map, of Mercator's projection, and {} on the ground "
            "in its middle; they are drawn {} apart",
            metresText(glm::vec2(mapM)), drawn, drawn);
    }
}

/// What to say of projections that are nowhere near true to scale but along a line or at a point
/// (GeoTIFF's codes): Mercator's, equirectangular, gnomonic to orthographic, Robinson's to Van der
/// Grinten's, cylindrical of equal area.
std::string takenAsTrueToScale(const Keys& keys) {
    constexpr std::uint16_t kProjectionMethod = 3075;
    const std::uint16_t method = keys.find(kProjectionMethod).value_or(0);
    const bool isKnown = isOneOf(keys.find(kProjected).value_or(0), {{3410, 3410}, {6933, 6933}});
    if (!isKnown && !isOneOf(method, {{7, 7}, {17, 17}, {19, 21}, {23, 25}, {28, 28}})) return "";
    return "its projection is not true to scale: its samples are drawn as far apart as on its map";
}

/// Spacing and what to say of it.
void useSteps(const GeoTags& tags, const Keys& keys, const Steps& steps, const std::string& file,
              GeoUnits& units) {
    const std::uint16_t code = keys.find(kProjected).value_or(0);
    const bool isGeographic = keys.find(kModelType) == kGeographic;
    const bool isPlate =
        !isGeographic && isOneOf(code, {{4087, 4088}, {32662, 32662}, {54001, 54001}});
    const double unitM = isGeographic ? keys.metresOfDegrees() : keys.metresOf(kLinearUnit);
    const std::optional<double> north = northOfMiddle(tags, steps);
    double latitude = 0.0;
    if (isGeographic || isPlate) {
        const double radians = isPlate ? unitM / kEarthRadiusM : glm::radians(1.0);
        latitude = north.value_or(0.0) * radians;
        if (std::abs(latitude) >= glm::radians(90.0)) {
            throw Error(
                fmt::format("{}: its middle has the latitude {:g}; allowed: between -90 and 90",
                            file, glm::degrees(latitude)));
        }
    }
    const Steps onGround{groundStep(steps.column, latitude), groundStep(steps.row, latitude)};
    const glm::dvec2 stepM = lengthsOf(onGround, file) * unitM;
    const glm::vec2 spacingM(stepM);
    const auto [least, most] = std::minmax(spacingM.x, spacingM.y);
    if (!(least > 0.0F) || !std::isfinite(most)) return;
    units.spacingM = spacingM;
    if (!isGeographic && isOneOf(code, {{3395, 3395}, {3785, 3785}, {3857, 3857}})) {
        useMercator(north ? std::optional(*north * unitM) : std::nullopt, stepM, units);
    } else if (isGeographic || isPlate) {
        if (!north) units.warning = takenAsAtTheEquator("of latitude and longitude", spacingM);
    } else {
        units.warning = takenAsOfAMap(keys);
        if (units.warning.empty()) units.warning = takenAsTrueToScale(keys);
        if (units.warning.empty()) units.warning = takenAsMetres(keys);
    }
}

}  // namespace

std::optional<float> floatIn(const std::string& text, const std::string& what) {
    const std::string number(trimmed(text));
    if (number.empty()) return std::nullopt;
    char* end = nullptr;
    const float value = std::strtof(number.c_str(), &end);
    if (*end == '\0') return value;
    throw Error(fmt::format("{} is '{}'; allowed: a number", what, number));
}

GeoUnits unitsOf(const GeoTags& tags, const std::string& file, bool needsSpacing) {
    const Keys keys(tags, file);
    GeoUnits units;
    const auto scale = floatIn(itemOf(tags.metadata, "scale"), file + ": its scale");
    const auto offset = floatIn(itemOf(tags.metadata, "offset"), file + ": its offset");
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
    units.unitWarning = units.scale == 0.0F ? "its scale of 0 makes all its heights the same"
                                            : heightsTakenAsMetres(tags, keys);
    if (const std::optional<Steps> steps = stepsOf(tags, needsSpacing, file)) {
        useSteps(tags, keys, *steps, file, units);
    } else if (tags.tiepoint.size() > 6) {
        units.warning =
            "its points on the ground (ModelTiepoint) are not used: they say no spacing";
    }
    return units;
}

glm::dvec2 groundStep(glm::dvec2 step, double latitude) {
    return {step.x * std::cos(latitude), step.y};
}

std::optional<double> middleOfTile(const std::string& name) {
    const auto isDigit = [&](std::size_t i) { return name[i] >= '0' && name[i] <= '9'; };
    const int side = name.empty() ? 0 : std::toupper(static_cast<unsigned char>(name[0]));
    const bool isLatitude = name.size() >= 3 && isDigit(1) && isDigit(2) &&
                            name.compare(1, 2, side == 'S' ? "90" : "89") <= 0;
    if (!isLatitude || (side != 'N' && side != 'S')) return std::nullopt;
    const double corner = 10.0 * (name[1] - '0') + (name[2] - '0');
    return glm::radians(side == 'N' ? corner + 0.5 : corner - 0.5);
}

}  // namespace gfxrepro::scene
