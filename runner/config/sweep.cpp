#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "engine/scene/scene_reference.h"
#include "runner/config/experiment.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using namespace types;

/// `axes`: keys that are as any other, but of every technique.
struct SweepKeys {
    GivenKey axes, zip, list, exclude, when;
};
const KeyTable<SweepKeys>& sweepTable() {
    using S = SweepKeys;
    static const Json axisType = anyOf({listOf(anything(), 1), refTo("axis")});
    static const KeyTable<S> table{
        {"sweep", "sweep.",
         "Any other key is a parameter of the technique, or as `scene.NAME` one of the generated "
         "scenes: it is an axis too. A condition's value may be a list: any of these.",
         true, anyOf({listOf(anything(), 1), refTo("axis"), {{"const", "all"}}})},
        {{&S::axes, "scene", "values", "none",
          "scenes; \"models/*.ply\" is all files of such a name",
          anyOf({text(), listOf(anything(), 1), refTo("axis")})},
         {&S::axes, "output.width", "values", "none", "widths of the image", axisType},
         {&S::axes, "output.height", "values", "none", "heights of the image", axisType},
         {&S::zip, "zip", "[{axis: values}]", "[]", "each block: axes that go together",
          listOf(mapOf(axisType))},
         {&S::list, "list", "[[{axis: value}]]", "[]",
          "each block: points spelt out; keys may differ", listOf(listOf(pairs(), 1))},
         {&S::exclude, "exclude", "[{axis: value}]", "[]", "drops points that match all pairs",
          listOf(pairs())},
         {&S::when, "when", "{axis: {other: value}}", "{}",
          "the axis applies only there: elsewhere tables show no value of it", mapOf(pairs())}}};
    return table;
}

struct AxisKeys {
    GivenKey range, log2;
};
const KeyTable<AxisKeys>& axisTable() {
    static const KeyTable<AxisKeys> table{
        {"axis",
         "values.",
         "Values are a list, or a map with one of these keys; `all` is what a program's parameter "
         "lists.",
         false,
         nullptr,
         {{"minProperties", 1}, {"maxProperties", 1}}},
        {{&AxisKeys::range,
          "range",
          "[first, last, step]",
          "none",
          "both ends included; step 1 may be left out",
          {{"type", "array"}, {"items", number()}, {"minItems", 2}, {"maxItems", 3}}},
         {&AxisKeys::log2, "log2", "[first, last]", "none", "powers of two, both ends included",
          tupleOf(number(), 2)}}};
    return table;
}

constexpr double kMaxPoints = 1'000'000;

/// Points that are chosen together: the values of one axis, or a zip or list block. A sweep is the
/// product of its factors.
using Factor = std::vector<AxisPoint>;

double countOfRange(const Node& range, double first, double last, double step) {
    if (step == 0.0) throwNotAllowed(range, "range", "a step that is not 0");
    if ((last - first) * step < 0.0) {
        throwNotAllowed(range, "range", "a step that leads from the first value to the last");
    }
    // Half a millionth of a step is forgiven: 1 is part of [0, 1, 0.1].
    return std::floor((last - first) / step + 5e-7) + 1;
}

void requireCount(double count, const SourceLocation& where, const std::string& what) {
    if (count > kMaxPoints) {
        throw Error(where,
                    fmt::format("{} has {:.0f} points; at most {}", what, count, kMaxPoints));
    }
}

/// [first, last], [first, last, step]: both ends included.
Node::Sequence valuesOfRange(const GivenKey& given, const std::string& axis) {
    const Node& range = *given;
    if (!range.isSequence() || range.items().size() < 2 || range.items().size() > 3) {
        throwNotAllowed(range, given.name(), "[first, last] or [first, last, step]");
    }
    const auto numberAt = [&](std::size_t i) {
        return numberIn(range.items()[i], {}, given.name());
    };
    const double first = numberAt(0), last = numberAt(1);
    const double step = range.items().size() == 3 ? numberAt(2) : 1.0;
    const double count = countOfRange(range, first, last, step);
    requireCount(count, range.location(), "axis '" + axis + "'");
    Node::Sequence values;
    for (int i = 0; i < static_cast<int>(count); ++i) {
        // Twelve digits: 0.3, not 0.30000000000000004.
        const auto value = parseDouble(fmt::format("{:.12g}", first + i * step));
        values.push_back(Node::number(value.value_or(first + i * step), range.location()));
    }
    return values;
}

/// [first, last]: powers of two, both ends included.
Node::Sequence valuesOfLog2(const GivenKey& given) {
    const Node& ends = *given;
    const auto refuse = [&] {
        throwNotAllowed(ends, given.name(), "[first, last], powers of two, the smaller first");
    };
    if (!ends.isSequence() || ends.items().size() != 2) refuse();
    const double first = numberIn(ends.items()[0], {}, given.name());
    const double last = numberIn(ends.items()[1], {}, given.name());
    for (const double end : {first, last}) {
        int exponent = 0;
        if (std::frexp(end, &exponent) != 0.5) refuse();
    }
    if (first > last) refuse();
    Node::Sequence values;
    for (double value = first; value <= last; value *= 2.0) {
        values.push_back(Node::number(value, ends.location()));
    }
    return values;
}

/// The values of one axis: a list, {range: …} or {log2: …}; `all` is a list when the file is read.
Node::Sequence valuesOfAxis(const std::string& axis, const Node& node) {
    const std::string what = "axis '" + axis + "'";
    const bool isOne = node.isMap() && node.entries().size() == 1;
    const AxisKeys given = isOne ? axisTable().find(node) : AxisKeys{};
    Node::Sequence values;
    if (node.isSequence()) {
        values = node.items();
    } else if (given.range) {
        values = valuesOfRange(given.range, axis);
    } else if (given.log2) {
        values = valuesOfLog2(given.log2);
    } else {
        throwNotAllowed(node, what,
                        "a list, {range: [first, last, step]}, {log2: [first, last]}, or all, of "
                        "a program's parameter that lists its values");
    }
    if (values.empty()) throw Error(node.location(), what + " has no values");
    return values;
}

void requireDifferent(const Node::Sequence& values, const std::string& axis) {
    std::set<std::string> seen;
    for (const Node& value : values) {
        if (seen.insert(contentKey(value)).second) continue;
        throw Error(value.location(),
                    "axis '" + axis + "' has the value " + value.toFlowText() + " twice");
    }
}

/// Gathers the factors and refuses an axis that two of them name.
class Factors {
  public:
    void addAxis(const std::string& axis, const Node& node, const SourceLocation& where) {
        claim(axis, where);
        Node::Sequence values = valuesOfAxis(axis, node);
        requireDifferent(values, axis);
        Factor factor;
        for (Node& value : values) factor.push_back({{axis, std::move(value)}});
        factors_.push_back(std::move(factor));
    }

    void addZips(const GivenKey& blocks) {
        for (const Node& block : blocks->items()) {
            if (!block.isMap() || block.entries().empty()) {
                throwNotAllowed(block, blocks.name(), "a list of maps, axis: values");
            }
            Factor factor;
            for (const auto& [axis, node] : block.entries()) {
                claim(axis, block.keyLocation(axis));
                Node::Sequence values = valuesOfAxis(axis, node);
                if (factor.empty()) factor.resize(values.size());
                if (values.size() != factor.size()) {
                    throw Error(
                        node.location(),
                        fmt::format("{}: axis '{}' has {} values, but '{}' has {}", blocks.name(),
                                    axis, values.size(), block.entries()[0].key(), factor.size()));
                }
                for (std::size_t i = 0; i < values.size(); ++i) {
                    factor[i].emplace_back(axis, std::move(values[i]));
                }
            }
            factors_.push_back(std::move(factor));
        }
    }

    void addLists(const GivenKey& blocks) {
        for (const Node& block : blocks->items()) {
            if (!block.isSequence() || block.items().empty()) {
                throwNotAllowed(block, blocks.name(),
                                "a list of blocks, each a list of points {axis: value}");
            }
            Factor factor;
            std::set<std::string> own;
            for (const Node& point : block.items()) {
                if (!point.isMap() || point.entries().empty()) {
                    throwNotAllowed(point, "a point of a list", "a map {axis: value}");
                }
                for (const auto& entry : point.entries()) {
                    if (own.insert(entry.key()).second) {
                        claim(entry.key(), point.keyLocation(entry.key()));
                    }
                }
                factor.emplace_back(point.entries().begin(), point.entries().end());
            }
            factors_.push_back(std::move(factor));
        }
    }

    const std::vector<std::string>& axes() const { return axes_; }
    /// Where the sweep names the axis first; null where it does not.
    const SourceLocation* placeOf(std::string_view axis) const {
        const auto found = std::ranges::find(axes_, axis);
        if (found == axes_.end()) return nullptr;
        return &places_[static_cast<std::size_t>(found - axes_.begin())];
    }

    /// Axes of the factor that has this one.
    std::set<std::string> besides(std::string_view axis) const {
        std::set<std::string> names;
        for (const Factor& factor : factors_) {
            std::set<std::string> own;
            for (const AxisPoint& point : factor) {
                for (const auto& [name, value] : point) own.insert(name);
            }
            if (own.erase(std::string(axis)) > 0) names = std::move(own);
        }
        return names;
    }

    std::vector<AxisPoint> product(const SourceLocation& where) const {
        double count = 1;
        for (const Factor& factor : factors_) count *= static_cast<double>(factor.size());
        requireCount(count, where, "the sweep");
        std::vector<AxisPoint> points = {{}};
        for (const Factor& factor : factors_) {
            std::vector<AxisPoint> longer;
            longer.reserve(points.size() * factor.size());
            for (const AxisPoint& point : points) {
                for (const AxisPoint& part : factor) {
                    longer.push_back(point);
                    longer.back().insert(longer.back().end(), part.begin(), part.end());
                }
            }
            points = std::move(longer);
        }
        return points;
    }

  private:
    void claim(const std::string& axis, const SourceLocation& where) {
        if (contains(axes_, axis)) {
            throw Error(where, "axis '" + axis + "' stands in the sweep twice");
        }
        axes_.push_back(axis);
        places_.push_back(where);
    }

    std::vector<Factor> factors_;
    std::vector<std::string> axes_;
    std::vector<SourceLocation> places_;  // beside `axes_`
};

void requireConditions(const Node& conditions, std::string_view what,
                       const std::vector<std::string>& axes) {
    requireKeys(conditions, what, axes);
    if (conditions.entries().empty()) throwNotAllowed(conditions, what, "a map {axis: value}");
}

/// Null where the point does not have the axis.
const Node* valueAt(const AxisPoint& point, std::string_view axis) {
    for (const auto& [name, value] : point) {
        if (name == axis) return &value;
    }
    return nullptr;
}

/// Whether the point has each axis that `conditions` names, with a value that matches.
bool matchesAll(const AxisPoint& point, const Node& conditions) {
    return std::all_of(conditions.entries().begin(), conditions.entries().end(),
                       [&](const auto& condition) {
                           const Node* value = valueAt(point, condition.key());
                           return value && matchesAny(*value, condition.value);
                       });
}

void dropDuplicates(std::vector<AxisPoint>& points) {
    std::set<std::string> seen;
    std::erase_if(points, [&](const AxisPoint& point) {
        std::string key;
        for (const auto& [axis, value] : point) key += axis + "=" + contentKey(value) + "\n";
        return !seen.insert(std::move(key)).second;
    });
}

Factors factorsOf(const Node& sweep) {
    Factors factors;
    const SweepKeys given = sweepTable().find(sweep);
    for (const auto& [key, node] : sweep.entries()) {
        if (&node == given.zip) {
            factors.addZips(given.zip);
        } else if (&node == given.list) {
            factors.addLists(given.list);
        } else if (&node != given.exclude && &node != given.when) {
            factors.addAxis(key, node, sweep.keyLocation(key));
        }
    }
    return factors;
}

/// A value that a config fixes.
struct Fixed {
    std::string axis;  // by which a sweep would name it
    std::string section;
    SourceLocation where;
    SourceLocation swept = {};
};

std::vector<Fixed> fixedOf(const Experiment& experiment) {
    std::vector<Fixed> all;
    const ContentKeys content = contentOf(experiment.document);
    const auto add = [&](const GivenKey& section, const Node& values, std::string_view prefix) {
        for (const auto& [name, value] : values.entries()) {
            all.push_back({std::string(prefix) + name, section.name(), value.location()});
        }
    };
    add(content.params, experiment.params, "");
    add(content.sceneParams, experiment.sceneParams, kSceneAxisPrefix);
    const GivenKey& output = content.output;
    if (output && output->isMap()) add(output, *output, output.name() + ".");
    if (!experiment.scene.isNull()) {
        all.push_back({"scene", "scene", experiment.scene.location()});
        const scene::SceneReference scene = scene::SceneReference::from(experiment.scene);
        for (const auto& [name, value] : scene.params.entries()) {
            all.push_back(
                {std::string(kSceneAxisPrefix) + name, "scene", experiment.scene.location()});
        }
    }
    return all;
}

/// Those whose axis is swept in every case. Where the sweep leaves it out, a case takes the fixed
/// value.
std::vector<Fixed> fixedInVain(const Experiment& experiment) {
    if (!experiment.sweep.isMap()) return {};
    const Factors factors = factorsOf(experiment.sweep);
    std::vector<AxisPoint> points;
    std::vector<Fixed> found;
    for (Fixed& fixed : fixedOf(experiment)) {
        const SourceLocation* swept = factors.placeOf(fixed.axis);
        if (!swept) continue;
        if (points.empty()) points = expandSweep(experiment.sweep);
        const auto isIn = [&](const AxisPoint& point) {
            return valueAt(point, fixed.axis) != nullptr;
        };
        if (!std::ranges::all_of(points, isIn)) continue;
        fixed.swept = *swept;
        found.push_back(std::move(fixed));
    }
    return found;
}

}  // namespace

const Node* whenOf(const Node& sweep) {
    return sweepTable().find(sweep).when;
}

std::set<std::string> axesBeside(const Node& sweep, std::string_view axis) {
    return sweep.isMap() ? factorsOf(sweep).besides(axis) : std::set<std::string>();
}

void applyWhen(const Node& when, AxisPoint& point) {
    for (std::size_t before = point.size() + 1; before != point.size();) {
        before = point.size();
        std::erase_if(point, [&, whole = point](const auto& axis) {
            const Node* conditions = when.find(axis.key());
            return conditions && !matchesAll(whole, *conditions);
        });
    }
}

void requireNotFixed(const Experiment& experiment) {
    for (const auto& [axis, section, fixed, swept] : fixedInVain(experiment)) {
        const bool isTyped = fixed.file.text().starts_with(kCommandLine);
        const bool isOwn = fixed.file == swept.file || fixed.file.text() == experiment.file;
        if (!isTyped && !(isOwn && fixed.line > 0)) continue;
        throw Error(fixed,
                    "'" + axis + "' is swept, too, in " + toString(swept) +
                        (isTyped ? "; use --sweep " + axis + "=… instead"
                                 : std::string("; allowed: in '") + section + "' or in 'sweep'"));
    }
}

std::vector<NoEffect> valuesInVain(const Experiment& experiment) {
    std::vector<NoEffect> found;
    for (const Fixed& fixed : fixedInVain(experiment)) {
        const bool isPart = fixed.axis != "scene" && fixed.section == std::string_view("scene");
        if (!isPart) found.push_back({fixed.where, "swept, too"});
    }
    return found;
}

std::vector<NoEffect> excludedInVain(const Experiment& experiment) {
    if (!experiment.sweep.isMap()) return {};
    const GivenKey exclude = sweepTable().find(experiment.sweep).exclude;
    if (!exclude) return {};
    Node whole = experiment.sweep;
    whole.erase(exclude.name());
    const std::vector<AxisPoint> points = expandSweep(whole);
    std::vector<NoEffect> found;
    for (const Node& pairs : exclude->items()) {
        const auto isMet = [&](const AxisPoint& point) { return matchesAll(point, pairs); };
        if (std::ranges::any_of(points, isMet)) continue;
        found.push_back({pairs.location(), fmt::format("{}: no point of the sweep has {}",
                                                       exclude.name(), pairs.toFlowText())});
    }
    return found;
}

std::vector<NoEffect> whenInVain(const Experiment& experiment) {
    if (!experiment.sweep.isMap()) return {};
    const SweepKeys given = sweepTable().find(experiment.sweep);
    if (!given.when) return {};
    Node whole = experiment.sweep;
    for (const GivenKey* key : {&given.when, &given.exclude}) whole.erase(key->name());
    const std::vector<AxisPoint> points = expandSweep(whole);
    std::vector<NoEffect> found;
    const auto look = [&](const std::string& what, const std::string& axis, const Node& wanted) {
        std::vector<std::string> values;
        bool isThere = false;
        for (const AxisPoint& point : points) {
            const Node* value = valueAt(point, axis);
            if (!value) continue;
            isThere |= matchesAny(*value, wanted);
            const std::string text = value->toFlowText();
            if (std::ranges::find(values, text) == values.end()) values.push_back(text);
        }
        if (isThere) return;
        found.push_back(
            {wanted.location(), fmt::format("{}.{} is {}; allowed: {}", what, axis,
                                            wanted.toFlowText(), joined(values, " | "))});
    };
    for (const auto& [axis, conditions] : given.when->entries()) {
        for (const auto& [other, wanted] : conditions.entries()) {
            look(fmt::format("{}: {}", given.when.name(), axis), other, wanted);
        }
    }
    return found;
}

std::vector<AxisPoint> expandSweep(const Node& sweep) {
    if (sweep.isNull()) return {{}};
    if (!sweep.isMap()) throwNotAllowed(sweep, "sweep", "a map, axis: values");
    const Factors factors = factorsOf(sweep);
    const SweepKeys given = sweepTable().find(sweep);
    const GivenKey &when = given.when, &exclude = given.exclude;
    if (when) {
        requireKeys(*when, when.name(), factors.axes());
        for (const auto& [axis, conditions] : when->entries()) {
            requireConditions(conditions, when.name(), factors.axes());
        }
    }
    if (exclude) {
        for (const Node& pairs : exclude->items()) {
            requireConditions(pairs, exclude.name(), factors.axes());
        }
    }

    std::vector<AxisPoint> points = factors.product(sweep.location());
    if (when) {
        for (AxisPoint& point : points) applyWhen(*when, point);
        dropDuplicates(points);
    }
    if (exclude) {
        for (const Node& pairs : exclude->items()) {
            std::erase_if(points, [&](const AxisPoint& point) { return matchesAll(point, pairs); });
        }
        if (points.empty())
            throw Error(exclude->location(), exclude.name() + " leaves no point of the sweep");
    }
    return points;
}

std::vector<SchemaSection> sweepKeys() {
    return {sweepTable().section(), axisTable().section()};
}

}  // namespace gfxrepro::config
