#include "engine/gl/pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/text.h"

namespace gfxrepro::gl {
namespace {

struct Words {
    std::set<std::string> declared;  // all of the declarations of blocks and of uniforms
    std::set<std::string> written;   // of those without `readonly`
};

bool isWordCharacter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Without comments and lines of the preprocessor: what #if leaves out counts too.
std::string codeOf(const std::string& source) {
    std::string code;
    for (std::size_t at = 0; at < source.size(); ++at) {
        const auto starts = [&](const char* text) { return source.compare(at, 2, text) == 0; };
        if (starts("/*")) {
            at = std::min(source.find("*/", at + 2), source.size() - 2) + 1;
        } else if (starts("//") || source[at] == '#') {
            at = std::min(source.find('\n', at), source.size());
        } else {
            code += source[at];
            continue;
        }
        code += ' ';
    }
    return code;
}

void addWords(const std::string& source, Words& words) {
    std::set<std::string> piece;  // from one of ; { } to the next
    std::string word;
    for (const char c : codeOf(source) + ';') {
        if (isWordCharacter(c)) {
            word += c;
            continue;
        }
        if (!word.empty()) piece.insert(std::exchange(word, {}));
        if (c != ';' && c != '{' && c != '}') continue;
        if (piece.contains("buffer") || piece.contains("uniform")) {
            words.declared.insert(piece.begin(), piece.end());
            if (!piece.contains("readonly")) words.written.insert(piece.begin(), piece.end());
        }
        piece.clear();
    }
}

Words wordsOf(GLuint program) {
    std::array<GLuint, 8> shaders{};
    GLsizei count = 0;
    glGetAttachedShaders(program, static_cast<GLsizei>(shaders.size()), &count, shaders.data());
    Words words;
    for (GLsizei i = 0; i < count; ++i) {
        GLint sizeBytes = 0;
        glGetShaderiv(shaders[static_cast<std::size_t>(i)], GL_SHADER_SOURCE_LENGTH, &sizeBytes);
        std::string source(static_cast<std::size_t>(sizeBytes), '\0');
        glGetShaderSource(shaders[static_cast<std::size_t>(i)], sizeBytes, nullptr, source.data());
        addWords(source, words);
    }
    return words;
}

std::string withoutIndex(std::string_view name) {
    return std::string(name.substr(0, name.find('[')));
}

std::string nameOf(GLuint program, GLenum interface, GLuint index) {
    const GLenum property = GL_NAME_LENGTH;
    GLint sizeBytes = 0;
    glGetProgramResourceiv(program, interface, index, 1, &property, 1, nullptr, &sizeBytes);
    std::string name(static_cast<std::size_t>(sizeBytes), '\0');
    glGetProgramResourceName(program, interface, index, sizeBytes, nullptr, name.data());
    name.pop_back();  // the terminating zero
    return name;
}

int activeCount(GLuint program, GLenum interface) {
    GLint count = 0;
    glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
    return count;
}

bool isImage(GLint type) {
    return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY;
}

/// GL's numbers of samplers stand in five blocks.
bool isSampler(GLint type) {
    const auto isIn = [type](GLint first, GLint last) { return type >= first && type <= last; };
    return isIn(GL_SAMPLER_1D, GL_SAMPLER_2D_RECT_SHADOW) ||
           isIn(GL_SAMPLER_1D_ARRAY, GL_SAMPLER_CUBE_SHADOW) ||
           isIn(GL_INT_SAMPLER_1D, GL_UNSIGNED_INT_SAMPLER_BUFFER) ||
           isIn(GL_SAMPLER_CUBE_MAP_ARRAY, GL_UNSIGNED_INT_SAMPLER_CUBE_MAP_ARRAY) ||
           isIn(GL_SAMPLER_2D_MULTISAMPLE, GL_UNSIGNED_INT_SAMPLER_2D_MULTISAMPLE_ARRAY);
}

struct SortInfo {
    const char* name;
    GLenum barrier, limit;
    const char* limitName;
};
constexpr SortInfo kSorts[] = {  // in the order of Pass::Sort
    {"storage block", GL_SHADER_STORAGE_BARRIER_BIT, GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS,
     "GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS"},
    {"uniform block", GL_UNIFORM_BARRIER_BIT, GL_MAX_UNIFORM_BUFFER_BINDINGS,
     "GL_MAX_UNIFORM_BUFFER_BINDINGS"},
    {"sampler", GL_TEXTURE_FETCH_BARRIER_BIT, GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS,
     "GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS"},
    {"image", GL_SHADER_IMAGE_ACCESS_BARRIER_BIT, GL_MAX_IMAGE_UNITS, "GL_MAX_IMAGE_UNITS"}};

}  // namespace

Resources Resources::with(const Resources& others) const {
    Resources both = *this;
    for (const Resource& other : others.all_) {
        both.all_.push_back(other);
        both.all_.back().mayBeUndeclared = true;
    }
    return both;
}

Pass::Pass(const ShaderLibrary& library, const std::vector<std::string>& files,
           const Defines& defines, const std::map<std::string, std::string>& snippets)
    : Program(library, files, defines, snippets), files_(joined(files, " + ")) {
    Words words = wordsOf(id());
    declared_ = std::move(words.declared);
    findBlocks(GL_SHADER_STORAGE_BLOCK, Sort::Storage, words.written);
    findBlocks(GL_UNIFORM_BLOCK, Sort::Uniform, {});
    findTextures(words.written);
}

void Pass::refuse(const std::string& what) const {
    throw Error(fmt::format("{}: {}", files_, what));
}

/// The next slot from the highest down.
GLuint Pass::take(Sort sort) {
    const SortInfo& info = kSorts[static_cast<int>(sort)];
    const auto taken = std::ranges::count(slots_, sort, &Slot::sort);
    const int limit = getInteger(info.limit);
    if (taken >= limit) {
        throw UnsupportedError(fmt::format("{}: more than {} {}s, this device's {}", files_, limit,
                                           info.name, info.limitName));
    }
    return static_cast<GLuint>(limit - 1 - taken);
}

void Pass::findBlocks(GLenum interface, Sort sort, const std::set<std::string>& written) {
    for (int i = 0; i < activeCount(id(), interface); ++i) {
        const auto index = static_cast<GLuint>(i);
        const std::string name = nameOf(id(), interface, index);
        const GLuint number = take(sort);
        if (sort == Sort::Storage) {
            glShaderStorageBlockBinding(id(), index, number);
        } else {
            glUniformBlockBinding(id(), index, number);
        }
        slots_.push_back({name, sort, number, written.contains(withoutIndex(name))});
    }
}

void Pass::findTextures(const std::set<std::string>& written) {
    for (int i = 0; i < activeCount(id(), GL_UNIFORM); ++i) {
        const auto index = static_cast<GLuint>(i);
        const std::array<GLenum, 3> properties{GL_TYPE, GL_ARRAY_SIZE, GL_LOCATION};
        std::array<GLint, 3> values{};
        glGetProgramResourceiv(id(), GL_UNIFORM, index, 3, properties.data(), 3, nullptr,
                               values.data());
        const auto [type, count, location] = values;
        if (!isImage(type) && !isSampler(type)) continue;
        const std::string name = nameOf(id(), GL_UNIFORM, index);
        const bool isArray = name.ends_with("[0]");
        for (int element = 0; element < count; ++element) {
            const Sort sort = isImage(type) ? Sort::Image : Sort::Sampler;
            const GLuint number = take(sort);
            glProgramUniform1i(id(), location + element, static_cast<GLint>(number));
            slots_.push_back({isArray ? fmt::format("{}[{}]", withoutIndex(name), element) : name,
                              sort, number,
                              sort == Sort::Image && written.contains(withoutIndex(name))});
        }
    }
}

GLbitfield Pass::noteUse(const Slot& slot, const Resource& resource) const {
    const SortInfo& info = kSorts[static_cast<int>(slot.sort)];
    const bool isBlock = slot.sort == Sort::Storage || slot.sort == Sort::Uniform;
    if (isBlock != (resource.buffer != nullptr)) {
        refuse(fmt::format("{} is a {} and is given a {}", slot.name, info.name,
                           isBlock ? "texture" : "buffer"));
    }
    ShaderAccesses& accesses = isBlock ? resource.buffer->accesses() : resource.texture->accesses();
    if (!slot.isWritten || !resource.isUnordered)
        return accesses.note(info.barrier, slot.isWritten);
    accesses.noteUnorderedWrite();
    return 0;
}

void Pass::use(const Resources& resources) const {
    GLbitfield barriers = 0;
    std::size_t given = 0;
    const std::vector<Resource>& all = resources.all();
    for (auto resource = all.begin(); resource != all.end(); ++resource) {
        if (std::any_of(all.begin(), resource,
                        [&](const Resource& r) { return r.name == resource->name; })) {
            refuse(fmt::format("{} is given twice", resource->name));
        }
        const auto slot = std::ranges::find(slots_, resource->name, &Slot::name);
        if (slot != slots_.end()) {
            ++given;
            barriers |= noteUse(*slot, *resource);
        } else if (!resource->mayBeUndeclared &&
                   !declared_.contains(withoutIndex(resource->name))) {
            refuse(fmt::format("no stage declares {}", resource->name));
        }
    }
    if (given < slots_.size()) {
        for (const Slot& slot : slots_) {
            if (std::ranges::find(all, slot.name, &Resource::name) != all.end()) continue;
            refuse(fmt::format("the {} {} is not given", kSorts[static_cast<int>(slot.sort)].name,
                               slot.name));
        }
    }
    if (barriers != 0) glMemoryBarrier(barriers);
    for (const Resource& resource : all) {
        const auto slot = std::ranges::find(slots_, resource.name, &Slot::name);
        if (slot != slots_.end()) bind(*slot, resource);
    }
    Program::use();
}

void Pass::bind(const Slot& slot, const Resource& resource) {
    if (slot.sort == Sort::Storage) {
        resource.buffer->bindStorage(slot.number);
    } else if (slot.sort == Sort::Uniform) {
        resource.buffer->bindUniform(slot.number);
    } else if (slot.sort == Sort::Sampler) {
        resource.texture->bind(slot.number);
    } else {
        const GLenum access = slot.isWritten ? GL_READ_WRITE : GL_READ_ONLY;
        if (resource.layer < 0) {
            resource.texture->bindImage(slot.number, access);
        } else {
            resource.texture->bindImageLayer(slot.number, resource.layer, access);
        }
    }
}

void Pass::dispatch(const glm::uvec3& groups, const Resources& resources) const {
    use(resources);
    glDispatchCompute(groups.x, groups.y, groups.z);
}

void Pass::dispatchIndirect(const Buffer& arguments, std::size_t offsetBytes,
                            const Resources& resources) const {
    arguments.awaitPasses(GL_COMMAND_BARRIER_BIT);
    use(resources);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments.id());
    glDispatchComputeIndirect(static_cast<GLintptr>(offsetBytes));
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

}  // namespace gfxrepro::gl
