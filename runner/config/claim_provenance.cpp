// Whose claim it is, where its bound comes from, and what is known of it.
#include <array>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "runner/config/schema.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using Names = std::vector<std::string>;
using Origin = ClaimSpec::Origin;
using BoundSource = ClaimSpec::BoundSource;
using TimeKind = ClaimSpec::TimeKind;

/// The value of `values` at the place where `node` stands among `names`.
template <class Value, std::size_t kCount>
Value named(const Node& node, const std::string& what,
            const std::array<std::string_view, kCount>& names) {
    const std::string text = node.isScalar() ? node.text() : "";
    for (std::size_t i = 0; i < kCount; ++i) {
        if (text == names[i]) return static_cast<Value>(i);
    }
    throwNotAllowed(node, what, joined(Names(names.begin(), names.end()), " | "));
}

template <std::size_t kCount>
std::optional<std::string> nameIn(const Node& map, const char* key, const std::string& what,
                                  const std::array<std::string_view, kCount>& names) {
    const Node* node = map.find(key);
    if (!node) return std::nullopt;
    return std::string(
        names[static_cast<std::size_t>(named<int>(*node, what + ": " + key, names))]);
}

ClaimSpec::Known readKnown(const Node& node, const std::string& what) {
    requireKeys(node, what, keysOf("because"));
    ClaimSpec::Known known;
    for (const char* key : {"verdict", "reason"}) {
        if (!node.find(key)) throw Error(node.location(), what + " needs '" + key + "'");
    }
    known.verdict = *nameIn(node, "verdict", what, kKnownVerdicts);
    known.device = nameIn(node, "device", what, kDeviceClasses);
    known.profile = nameIn(node, "profile", what, kProfiles);
    known.scenes = nameIn(node, "scenes", what, kSceneClasses);
    known.reason = lineOf(*node.find("reason"), what + ": reason");
    if (const Node* shown = node.find("shown_by")) {
        known.shownBy = lineOf(*shown, what + ": shown_by");
    }
    return known;
}

std::string knownPlace(const ClaimSpec::Known& known) {
    return known.device.value_or("any device") + ", " + known.profile.value_or("any profile") +
           (known.scenes ? ", scenes: " + *known.scenes : "");
}

/// The first that is of a device, profile and kind of scenes is taken: a later one may be of more,
/// never of what an earlier one has.
void requireApart(const std::vector<ClaimSpec::Known>& known, const Node::Sequence& entries,
                  const std::string& what) {
    using Place = std::array<std::optional<std::string>, 3>;
    const auto place = [](const ClaimSpec::Known& one) {
        return Place{one.device, one.profile, one.scenes};
    };
    for (std::size_t later = 1; later < known.size(); ++later) {
        for (std::size_t i = 0; i < later; ++i) {
            const ClaimSpec::Known &one = known[i], &other = known[later];
            const Place narrow = place(one), wide = place(other);
            bool areApart = false, isWithin = true;
            for (std::size_t k = 0; k < narrow.size(); ++k) {
                areApart |= narrow[k] && wide[k] && narrow[k] != wide[k];
                isWithin &= !wide[k] || narrow[k] == wide[k];
            }
            if (areApart || (isWithin && narrow != wide)) continue;
            throw Error(entries[later].location(),
                        what + " is of " + knownPlace(other) + ", and an earlier one of " +
                            knownPlace(one) +
                            "; allowed: one for each device, profile and kind of "
                            "scenes, what is of more behind what is of less");
        }
    }
}

}  // namespace

bool ClaimSpec::hasBound() const {
    return (low || high) && type != Type::Order && type != Type::SameMean;
}

std::string_view originName(Origin origin) {
    return kOrigins[static_cast<std::size_t>(origin)];
}

std::string_view boundSourceName(BoundSource source) {
    return kBoundSources[static_cast<std::size_t>(source)];
}

std::string_view timeKindName(TimeKind kind) {
    return kTimeKinds[static_cast<std::size_t>(kind)];
}

void readProvenance(const Node& node, const std::string& what, ClaimSpec& claim) {
    if (const Node* origin = node.find("origin")) {
        claim.origin = named<Origin>(*origin, what + ": origin", kOrigins);
    }
    if (const Node* source = node.find("bound_from")) {
        if (!claim.hasBound()) {
            throw Error(source->location(),
                        what + ": bound_from, and there is no number in what it requires");
        }
        claim.boundFrom = named<BoundSource>(*source, what + ": bound_from", kBoundSources);
    }
    if (const Node* kind = node.find("kind")) {
        claim.timeKind = named<TimeKind>(*kind, what + ": kind", kTimeKinds);
        if (const Node* device = node.find("device")) {
            throw Error(device->location(), what + ": device beside kind, which decides it");
        }
        if (claim.timeKind != TimeKind::Algorithmic) claim.device = ClaimSpec::Device::Gpu;
    }
    const Node* because = node.find("because");
    if (!because) return;
    const Node::Sequence entries =
        because->isSequence() ? because->items() : Node::Sequence{*because};
    for (const Node& entry : entries) claim.because.push_back(readKnown(entry, what + ": because"));
    requireApart(claim.because, entries, what + ": because");
}

}  // namespace gfxrepro::config
