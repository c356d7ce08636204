// Programs whose buffers and textures are given by their names in GLSL.
#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/program.h"

namespace gfxrepro::gl {

/// A buffer or a texture under the name that a shader gives it: of a block (`buffer Areas {…}` is
/// "Areas", whatever its members are called), a sampler, or an image; "maps[1]" of an array.
struct Resource {
    Resource(std::string_view glslName, const Buffer& block) : name(glslName), buffer(&block) {}
    Resource(std::string_view glslName, const Texture& whole) : name(glslName), texture(&whole) {}
    /// One layer of an array as an image.
    Resource(std::string_view glslName, const Texture& array, int imageLayer)
        : name(glslName), texture(&array), layer(imageLayer) {}
    /// Passes in a row write to different places of it, and do not wait for one another.
    Resource unordered() const {
        Resource copy = *this;
        copy.isUnordered = true;
        return copy;
    }

    std::string name;
    const Buffer* buffer = nullptr;
    const Texture* texture = nullptr;
    int layer = -1;  // -1: all
    bool mayBeUndeclared = false;
    bool isUnordered = false;
};

/// What a pass reads and writes; lives as long as the call that it is given to.
class Resources {
  public:
    Resources(std::initializer_list<Resource> resources) : all_(resources) {}
    /// One more: an element of an array, whose name is put together.
    void add(Resource resource) { all_.push_back(std::move(resource)); }
    /// These and `others`, which several passes share and not each of them declares.
    Resources with(const Resources& others) const;
    const std::vector<Resource>& all() const { return all_; }

  private:
    std::vector<Resource> all_;
};

/// A program that has slots of its own for all that its stages use, found after linking; what
/// `layout(binding = …)` says, if anything, does not count. It takes GL's highest slots, so that
/// code that binds to numbers keeps the low ones.
///
/// Barriers follow from the qualifiers in the shaders: a block or an image is written unless its
/// declaration says `readonly`. A pass waits for earlier passes that wrote what it uses, or used
/// what it writes. Pictures that are drawn into, vertices, indices and arguments of draws are
/// not a pass's resources: where a pass wrote them, awaitPasses() comes before the draw.
class Pass : public Program {
  public:
    Pass() = default;
    /// Throws as Program does, and UnsupportedError where the device has too few slots.
    Pass(const ShaderLibrary& library, const std::vector<std::string>& files,
         const Defines& defines = {}, const std::map<std::string, std::string>& snippets = {});

    /// For the draws that follow: makes the program current and binds. Throws Error naming what
    /// the program uses and is not given, what is given twice or is of the wrong sort, and what no
    /// stage declares (but see with()). What is declared and not used may be given.
    void use(const Resources& resources) const;
    /// use() and glDispatchCompute.
    void dispatch(const glm::uvec3& groups, const Resources& resources) const;
    /// use() and glDispatchComputeIndirect: `arguments` has the groups at `offsetBytes`.
    void dispatchIndirect(const Buffer& arguments, std::size_t offsetBytes,
                          const Resources& resources) const;

  private:
    enum class Sort { Storage, Uniform, Sampler, Image };
    struct Slot {
        std::string name;
        Sort sort = Sort::Storage;
        GLuint number = 0;
        bool isWritten = false;
    };
    void findBlocks(GLenum interface, Sort sort, const std::set<std::string>& written);
    void findTextures(const std::set<std::string>& written);
    GLuint take(Sort sort);
    GLbitfield noteUse(const Slot& slot, const Resource& resource) const;
    static void bind(const Slot& slot, const Resource& resource);
    [[noreturn]] void refuse(const std::string& what) const;

    std::string files_;
    std::set<std::string> declared_;  // the words of declarations, names among them
    std::vector<Slot> slots_;
};

}  // namespace gfxrepro::gl
