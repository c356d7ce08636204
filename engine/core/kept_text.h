// Texts that very many values have: kept once.
#pragma once

#include <string>

namespace gfxrepro {

/// A text that is kept once, for as long as the program runs, however many have it: the names of
/// files in places, the keys of maps. A plan of 100,000 cases has millions of each.
class KeptText {
  public:
    KeptText() = default;
    KeptText(const std::string& text);
    KeptText(const char* text) : KeptText(std::string(text)) {}

    const std::string& text() const {
        static const std::string kNone;
        return text_ ? *text_ : kNone;
    }
    operator const std::string&() const { return text(); }
    bool empty() const { return text_ == nullptr; }
    bool operator==(const KeptText& other) const = default;

  private:
    const std::string* text_ = nullptr;  // null: empty
};

}  // namespace gfxrepro
