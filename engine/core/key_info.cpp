#include "engine/core/key_info.h"

#include "engine/core/checks.h"
#include "engine/core/text.h"

namespace gfxrepro {

std::string KeyInfo::allowed() const {
    if (type == "boolean") return "true | false";
    return choices.empty() ? range.text() : joined(choices, " | ");
}

std::string KeyInfo::inWords() const {
    if (!choices.empty()) return allowed();
    const std::string numbers = range.text(unit);
    return numbers.empty() ? type : type + ", " + numbers;
}

std::string GivenKey::in(const std::string& owner) const {
    return owner.empty() ? name() : owner + ": " + name();
}

double GivenKey::number(const std::string& owner) const {
    return numberIn(*node_, declared_->range, in(owner), declared_->unit);
}

bool GivenKey::flag(const std::string& owner) const {
    return flagOf(*node_, in(owner));
}

std::size_t GivenKey::choice(const std::string& owner) const {
    return choiceOf(*node_, declared_->choices, in(owner));
}

}  // namespace gfxrepro
