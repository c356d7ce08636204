#include "tests/drivers/hazards/hazards.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>

#include "tests/drivers/hazards/programs.h"

namespace gfxrepro::hazards {

namespace {

/// What shaders did to memory that no barrier orders yet.
struct Accesses {
    GLbitfield unseenBy = 0;     // kinds of use that do not see the last write
    GLbitfield unawaitedBy = 0;  // kinds of write that do not wait for the reads since
    GLuint writer = 0;
};
/// A level of a texture's storage, which views share; a buffer's is −1.
using Memory = std::pair<int, GLint>;
std::map<Memory, Accesses> accesses;

struct Storage {
    int id = 0;
    GLint firstLevel = 0;
};
// By GL's names, which come again after they are deleted.
std::map<GLuint, Storage> buffers, textures;
std::map<GLuint, Program> programs;

std::set<Memory> drawnInto;  // since the framebuffer was bound, or glTextureBarrier
bool isBehindTextureBarrier = false;
std::vector<std::string> found;
std::vector<std::string> groups;  // that are open, the innermost last
GLuint lastProgram = 0;           // that drew or was dispatched

Storage storageOf(std::map<GLuint, Storage>& names, GLuint name) {
    static int last = 0;
    const auto [entry, isNew] = names.try_emplace(name);
    if (isNew) entry->second.id = ++last;
    return entry->second;
}

void say(const std::string& line) {
    static std::set<std::string> said;
    const char* path = std::getenv("HAZARDS");
    if (!path || !said.insert(line).second) return;
    const int file = ::open(path, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    const std::string text = line + '\n';
    if (file < 0 || ::write(file, text.data(), text.size()) < 0) std::abort();
    ::close(file);
}

void find(const std::string& what) {
    found.push_back(what);
    say("hazard: " + what);
}

std::string nameOf(GLuint program) {
    const auto entry = programs.find(program);
    return entry == programs.end() ? "a program" : entry->second.name;
}

const char* bitName(GLbitfield bit) {
    switch (bit) {
        case GL_SHADER_STORAGE_BARRIER_BIT:
            return "GL_SHADER_STORAGE_BARRIER_BIT";
        case GL_SHADER_IMAGE_ACCESS_BARRIER_BIT:
            return "GL_SHADER_IMAGE_ACCESS_BARRIER_BIT";
        case GL_TEXTURE_FETCH_BARRIER_BIT:
            return "GL_TEXTURE_FETCH_BARRIER_BIT";
        case GL_UNIFORM_BARRIER_BIT:
            return "GL_UNIFORM_BARRIER_BIT";
        case GL_COMMAND_BARRIER_BIT:
            return "GL_COMMAND_BARRIER_BIT";
        case GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT:
            return "GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT";
        case GL_ELEMENT_ARRAY_BARRIER_BIT:
            return "GL_ELEMENT_ARRAY_BARRIER_BIT";
        case GL_FRAMEBUFFER_BARRIER_BIT:
            return "GL_FRAMEBUFFER_BARRIER_BIT";
        case GL_BUFFER_UPDATE_BARRIER_BIT:
            return "GL_BUFFER_UPDATE_BARRIER_BIT";
        case GL_TEXTURE_UPDATE_BARRIER_BIT:
            return "GL_TEXTURE_UPDATE_BARRIER_BIT";
        default:
            return "GL_TRANSFORM_FEEDBACK_BARRIER_BIT";
    }
}

const Program& programOf(GLuint id) {
    const auto [entry, isNew] = programs.try_emplace(id);
    if (isNew) {
        entry->second = describe(id);
        say("checked: " + entry->second.name);
    }
    return entry->second;
}

struct Use {
    Memory memory;
    GLbitfield bit = 0;
    std::string name;
    bool isWrite = false;
    bool isShaders = true;  // what commands do is in order for what follows
};

/// Of one draw, dispatch or command by `program` (0: a command).
void check(GLuint program, const std::string& by, const std::vector<Use>& uses) {
    for (const Use& use : uses) {
        const Accesses& before = accesses[use.memory];
        const bool isGoingOn = use.isWrite && before.writer == program;
        if ((before.unseenBy & use.bit) != 0 && !isGoingOn) {
            find(by + ": " + use.name + " is what " + nameOf(before.writer) + " wrote, without " +
                 bitName(use.bit));
        }
        if (use.isWrite && (before.unawaitedBy & use.bit) != 0) {
            find(by + ": " + use.name + " is written behind reads, without " + bitName(use.bit));
        }
    }
    for (const Use& use : uses) {
        if (use.isShaders && !use.isWrite) {
            accesses[use.memory].unawaitedBy |=
                GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
        }
    }
    for (const Use& use : uses) {
        if (use.isWrite) accesses[use.memory] = {GL_ALL_BARRIER_BITS, 0, program};
    }
}

GLuint getName(GLenum what) {
    GLint value = 0;
    glGetIntegerv(what, &value);
    return static_cast<GLuint>(value);
}

GLuint getName(GLenum what, GLuint index) {
    GLint value = 0;
    glGetIntegeri_v(what, index, &value);
    return static_cast<GLuint>(value);
}

Memory memoryOfBuffer(GLuint name) {
    return {storageOf(buffers, name).id, -1};
}

std::vector<Memory> levelsOf(GLuint texture) {
    GLint count = 1;
    glGetTextureParameteriv(texture, GL_TEXTURE_VIEW_NUM_LEVELS, &count);
    const Storage storage = storageOf(textures, texture);
    std::vector<Memory> levels;
    for (GLint level = 0; level < count; ++level) {
        levels.emplace_back(storage.id, storage.firstLevel + level);
    }
    return levels;
}

struct Attachment {
    GLenum point = GL_NONE;
    Memory memory;
};

std::vector<Attachment> attachmentsOf(GLuint framebuffer) {
    std::vector<Attachment> attachments;
    if (framebuffer == 0) return attachments;
    const auto get = [&](GLenum point, GLenum what) {
        GLint value = 0;
        glGetNamedFramebufferAttachmentParameteriv(framebuffer, point, what, &value);
        return value;
    };
    std::vector<GLenum> points{GL_DEPTH_ATTACHMENT};
    for (GLenum i = 0; i < 8; ++i) points.push_back(GL_COLOR_ATTACHMENT0 + i);
    for (const GLenum point : points) {
        if (get(point, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) != GL_TEXTURE) continue;
        const auto texture = static_cast<GLuint>(get(point, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
        const Storage storage = storageOf(textures, texture);
        const GLint level = get(point, GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL);
        attachments.push_back({point, {storage.id, storage.firstLevel + level}});
    }
    return attachments;
}

bool isDrawnInto(GLenum point) {
    if (point == GL_DEPTH_ATTACHMENT) {
        GLboolean isKept = GL_FALSE;
        glGetBooleanv(GL_DEPTH_WRITEMASK, &isKept);
        return isKept && glIsEnabled(GL_DEPTH_TEST);
    }
    std::array<GLboolean, 4> mask{};
    for (GLuint i = 0; i < 8; ++i) {
        if (getName(GL_DRAW_BUFFER0 + i) != point) continue;
        glGetBooleani_v(GL_COLOR_WRITEMASK, i, mask.data());
    }
    return mask[0] || mask[1] || mask[2] || mask[3];
}

void addShaderUses(GLuint id, const Program& program, std::vector<Use>& uses) {
    const auto addBlocks = [&](const std::vector<Variable>& blocks, GLenum interface,
                               GLenum binding, GLbitfield bit) {
        for (const Variable& block : blocks) {
            const GLint slot = resourceNumber(id, interface, block.index, GL_BUFFER_BINDING);
            const GLuint buffer = getName(binding, static_cast<GLuint>(slot));
            if (buffer == 0) find(program.name + ": the block " + block.name + " has no buffer");
            if (buffer == 0) continue;
            uses.push_back({memoryOfBuffer(buffer), bit, block.name, block.isWritten});
        }
    };
    addBlocks(program.storageBlocks, GL_SHADER_STORAGE_BLOCK, GL_SHADER_STORAGE_BUFFER_BINDING,
              GL_SHADER_STORAGE_BARRIER_BIT);
    addBlocks(program.uniformBlocks, GL_UNIFORM_BLOCK, GL_UNIFORM_BUFFER_BINDING,
              GL_UNIFORM_BARRIER_BIT);
    const auto slotOf = [&](const Variable& variable) {
        GLint slot = 0;
        glGetUniformiv(id, variable.location, &slot);
        return static_cast<GLuint>(slot);
    };
    for (const Variable& sampler : program.samplers) {
        const GLuint texture = getName(sampler.binding, slotOf(sampler));
        if (texture == 0) find(program.name + ": the sampler " + sampler.name + " has no texture");
        if (texture == 0) continue;
        for (const Memory& level : levelsOf(texture)) {
            uses.push_back({level, GL_TEXTURE_FETCH_BARRIER_BIT, sampler.name});
        }
    }
    for (const Variable& image : program.images) {
        const GLuint slot = slotOf(image);
        const GLuint texture = getName(GL_IMAGE_BINDING_NAME, slot);
        if (texture == 0) find(program.name + ": the image " + image.name + " has no texture");
        if (texture == 0) continue;
        const Storage storage = storageOf(textures, texture);
        const auto level = static_cast<GLint>(getName(GL_IMAGE_BINDING_LEVEL, slot));
        const bool isWritten =
            image.isWritten && getName(GL_IMAGE_BINDING_ACCESS, slot) != GL_READ_ONLY;
        uses.push_back({{storage.id, storage.firstLevel + level},
                        GL_SHADER_IMAGE_ACCESS_BARRIER_BIT,
                        image.name,
                        isWritten});
    }
}

void addDrawUses(const std::string& program, bool isIndexed, std::vector<Use>& uses) {
    const std::size_t shaders = uses.size();
    for (const Attachment& attachment : attachmentsOf(getName(GL_DRAW_FRAMEBUFFER_BINDING))) {
        const bool isWritten = isDrawnInto(attachment.point);
        for (std::size_t i = 0; i < shaders; ++i) {
            if (uses[i].memory != attachment.memory || isBehindTextureBarrier) continue;
            if (!isWritten && !drawnInto.contains(attachment.memory)) continue;
            find(program + ": " + uses[i].name + " is drawn into, without glTextureBarrier");
        }
        if (isWritten) drawnInto.insert(attachment.memory);
        uses.push_back({attachment.memory, GL_FRAMEBUFFER_BARRIER_BIT, "the picture drawn into",
                        false, false});
    }
    for (GLuint i = 0; i < 16; ++i) {
        GLint isEnabled = 0, buffer = 0;
        glGetVertexAttribiv(i, GL_VERTEX_ATTRIB_ARRAY_ENABLED, &isEnabled);
        if (!isEnabled) continue;
        glGetVertexAttribiv(i, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING, &buffer);
        uses.push_back({memoryOfBuffer(static_cast<GLuint>(buffer)),
                        GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT, "a vertex attribute", false, false});
    }
    if (isIndexed) {
        uses.push_back({memoryOfBuffer(getName(GL_ELEMENT_ARRAY_BUFFER_BINDING)),
                        GL_ELEMENT_ARRAY_BARRIER_BIT, "the indices", false, false});
    }
    isBehindTextureBarrier = false;
}

void useArguments(GLenum binding, std::vector<Use>& uses) {
    if (binding == GL_NONE) return;
    uses.push_back(
        {memoryOfBuffer(getName(binding)), GL_COMMAND_BARRIER_BIT, "the arguments", false, false});
}

}  // namespace

std::vector<std::string> take() {
    return std::exchange(found, {});
}

void dispatch(GLenum arguments) {
    const GLuint id = lastProgram = getName(GL_CURRENT_PROGRAM);
    std::vector<Use> uses;
    addShaderUses(id, programOf(id), uses);
    useArguments(arguments, uses);
    check(id, nameOf(id), uses);
}

void draw(bool isIndexed, GLenum arguments) {
    const GLuint id = lastProgram = getName(GL_CURRENT_PROGRAM);
    std::vector<Use> uses;
    addShaderUses(id, programOf(id), uses);
    addDrawUses(nameOf(id), isIndexed, uses);
    useArguments(arguments, uses);
    check(id, nameOf(id), uses);
    isBehindTextureBarrier = false;
}

void useBuffer(const char* command, GLuint buffer, GLbitfield bit) {
    check(0, command, {{memoryOfBuffer(buffer), bit, "the buffer", false, false}});
}

void useTexture(const char* command, GLuint texture, GLbitfield bit) {
    for (const Memory& level : levelsOf(texture)) {
        check(0, command, {{level, bit, "the texture", false, false}});
    }
}

void clearBuffer(GLuint buffer) {
    useBuffer("glClearNamedBufferData", buffer);
    accesses.erase(memoryOfBuffer(buffer));
}

void clearTexture(GLuint texture) {
    useTexture("glClearTexImage", texture);
    for (const Memory& level : levelsOf(texture)) accesses.erase(level);
}

void clearPicture(GLuint framebuffer, GLenum buffer, GLint index) {
    const GLenum point = buffer == GL_COLOR ? GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index)
                                            : GL_DEPTH_ATTACHMENT;
    for (const Attachment& attachment : attachmentsOf(framebuffer)) {
        if (attachment.point != point) continue;
        check(0, "glClearNamedFramebuffer",
              {{attachment.memory, GL_FRAMEBUFFER_BARRIER_BIT, "the picture", false, false}});
    }
}

void beginGroup(const char* name) {
    groups.emplace_back(name);
}

void endGroup() {
    groups.pop_back();
}

void readBack(const char* command) {
    if (std::ranges::find(groups, "frame") == groups.end()) return;
    find(std::string(command) + ": reads back within a frame, behind " + nameOf(lastProgram));
}

void memoryBarrier(GLbitfield bits) {
    for (auto& [memory, access] : accesses) {
        access.unseenBy &= ~bits;
        access.unawaitedBy &= ~bits;
    }
}

void textureBarrier() {
    isBehindTextureBarrier = true;
    drawnInto.clear();
}

void bindFramebuffer(GLuint framebuffer) {
    if (framebuffer != getName(GL_DRAW_FRAMEBUFFER_BINDING)) drawnInto.clear();
}

void viewTexture(GLuint view, GLuint texture, GLuint firstLevel) {
    Storage storage = storageOf(textures, texture);
    storage.firstLevel += static_cast<GLint>(firstLevel);
    textures[view] = storage;
}

void forgetBuffer(GLuint buffer) {
    buffers.erase(buffer);
}

void forgetTexture(GLuint texture) {
    textures.erase(texture);
}

void forgetProgram(GLuint program) {
    programs.erase(program);
}

}  // namespace gfxrepro::hazards
