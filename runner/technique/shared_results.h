// What several cases of a worker have in common, such as the truth of a view: made once.
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <typeinfo>

#include "engine/core/node.h"

namespace gfxrepro::technique {

/// Results of earlier cases, by all that a case is but what its technique names as of no influence,
/// and whether it saves pictures: a parameter that nobody names keeps results apart.
class SharedResults {
  public:
    /// All together take at most `mostBytes`; those that were asked for longest ago go.
    explicit SharedResults(std::size_t mostBytes = std::size_t{512} << 20)
        : mostBytes_(mostBytes) {}

    /// `work` is technique, scene, size, seed and frames of the next case, `params` has the value
    /// in force of every parameter.
    void beginCase(std::string work, Node params);

    /// What `make` gives, or gave for an earlier case with which the present one has all in common
    /// but the parameters `regardless` and `pictures`. `name` tells results of one case apart. T
    /// has sizeBytes().
    template <class T>
    std::shared_ptr<const T> get(std::string_view name,
                                 std::initializer_list<const char*> regardless,
                                 const std::function<T()>& make) {
        const std::string key = keyOf(std::string(name) + ' ' + typeid(T).name(), regardless);
        if (const auto known = find(key)) return std::static_pointer_cast<const T>(known);
        const auto made = std::make_shared<const T>(make());
        add(key, made, made->sizeBytes());
        return made;
    }

    /// What is larger is not kept.
    std::size_t mostBytes() const { return mostBytes_; }
    /// Of results that the present case has not asked for.
    std::size_t otherBytes() const;

  private:
    struct KeptResult {
        std::string key;
        std::shared_ptr<const void> result;
        std::size_t sizeBytes = 0;
        bool isOfThisCase = true;
    };

    std::string keyOf(const std::string& name, std::initializer_list<const char*> regardless) const;
    std::shared_ptr<const void> find(const std::string& key);
    void add(const std::string& key, std::shared_ptr<const void> result, std::size_t sizeBytes);

    std::size_t mostBytes_;
    std::string work_;
    Node params_;
    std::list<KeptResult> entries_;  // the one asked for last first
};

/// … where a case shares nothing (null), made for it alone.
template <class T>
std::shared_ptr<const T> sharedResult(SharedResults* shared, std::string_view name,
                                      std::initializer_list<const char*> regardless,
                                      const std::function<T()>& make) {
    if (!shared) return std::make_shared<const T>(make());
    return shared->get<T>(name, regardless, make);
}

}  // namespace gfxrepro::technique
