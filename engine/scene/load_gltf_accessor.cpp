#include "engine/scene/load_gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "engine/core/error.h"

namespace gfxrepro::scene::gltf {

namespace {

template <class T>
T load(const unsigned char* from) {
    T value;
    std::memcpy(&value, from, sizeof(T));
    return value;
}

/// glTF 2.0, Sec. 3.6.2.2: integers as parts of their maximum, never below −1.
template <class T>
float converted(const unsigned char* from, bool isNormalized) {
    const auto value = static_cast<float>(load<T>(from));
    if (!isNormalized) return value;
    return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
}

float component(const unsigned char* from, int type, bool isNormalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return converted<std::int8_t>(from, isNormalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return converted<std::uint8_t>(from, isNormalized);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return converted<std::int16_t>(from, isNormalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return converted<std::uint16_t>(from, isNormalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return converted<std::uint32_t>(from, isNormalized);
        default:
            return load<float>(from);
    }
}

std::uint32_t unsignedInteger(const unsigned char* from, int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<std::uint8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(from);
        default:
            return load<std::uint32_t>(from);
    }
}

/// 0 for types that an accessor may not have.
std::size_t componentBytes(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

bool isUnsigned(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// `count` elements of `bytes`, `stride` apart.
struct Rows {
    const unsigned char* begin = nullptr;
    std::size_t stride = 0;
};

/// One accessor after its checks.
class Elements {
  public:
    Elements(const Accessors& accessors, const File& file, int index)
        : accessors_(accessors),
          where_(fmt::format("{}: accessor {}", file.name, index)),
          model_(file.model) {
        if (index < 0 || static_cast<std::size_t>(index) >= model_.accessors.size()) {
            fail(fmt::format("does not exist; there are {}", model_.accessors.size()));
        }
        accessor_ = &model_.accessors[static_cast<std::size_t>(index)];
        components_ = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_->type));
        if (componentBytes(accessor_->componentType) == 0) {
            fail(fmt::format("has the unknown component type {}", accessor_->componentType));
        }
    }

    int components() const { return components_; }
    std::size_t count() const { return accessor_->count; }
    int componentType() const { return accessor_->componentType; }
    bool isNormalized() const { return accessor_->normalized; }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(where_ + ' ' + message);
    }

    /// Calls visit(i, bytes of element i), in order, then again for the elements that sparse values
    /// replace. Without a buffer view the elements are zero and only the replaced ones visited.
    template <class Visit>
    void forEach(Visit&& visit) const {
        const std::size_t bytes =
            componentBytes(accessor_->componentType) * static_cast<std::size_t>(components_);
        if (accessor_->bufferView >= 0) {
            const Rows rows = rowsOf(accessor_->bufferView, accessor_->byteOffset, count(), bytes);
            for (std::size_t i = 0; i < count(); ++i) visit(i, rows.begin + i * rows.stride);
        }
        if (!accessor_->sparse.isSparse) return;
        const auto& sparse = accessor_->sparse;
        const int indexType = sparse.indices.componentType;
        if (sparse.count < 0 || !isUnsigned(indexType)) fail("has sparse values without indices");
        const auto sparseCount = static_cast<std::size_t>(sparse.count);
        const Rows indices = rowsOf(sparse.indices.bufferView, offset(sparse.indices.byteOffset),
                                    sparseCount, componentBytes(indexType));
        const Rows values =
            rowsOf(sparse.values.bufferView, offset(sparse.values.byteOffset), sparseCount, bytes);
        for (std::size_t i = 0; i < sparseCount; ++i) {
            const auto index = unsignedInteger(indices.begin + i * indices.stride, indexType);
            if (index >= count()) {
                fail(fmt::format("replaces element {} of {}", index, count()));
            }
            visit(index, values.begin + i * values.stride);
        }
    }

  private:
    /// tinygltf's offsets are int before 2.9, std::size_t from there on.
    template <class Integer>
    std::size_t offset(Integer bytes) const {
        if (!std::in_range<std::size_t>(bytes)) fail("has a negative offset");
        return static_cast<std::size_t>(bytes);
    }

    Rows rowsOf(int viewIndex, std::size_t offset, std::size_t count, std::size_t bytes) const {
        const std::span<const unsigned char> view = accessors_.view(viewIndex);
        const std::size_t given =
            model_.bufferViews[static_cast<std::size_t>(viewIndex)].byteStride;
        const std::size_t stride = given != 0 ? given : bytes;
        if (stride < bytes)
            fail(fmt::format("has a stride of {} bytes; {} are needed", stride, bytes));
        if (count == 0) return {};
        if (offset > view.size() || view.size() - offset < bytes ||
            (view.size() - offset - bytes) / stride < count - 1) {
            fail(fmt::format("reaches beyond its buffer view of {} bytes", view.size()));
        }
        return {view.data() + offset, stride};
    }

    const Accessors& accessors_;
    std::string where_;
    const tinygltf::Model& model_;
    const tinygltf::Accessor* accessor_ = nullptr;
    int components_ = 0;
};

}  // namespace

Accessors::Accessors(const File& file) : file_(file) {
    constexpr std::uint64_t kAlwaysAllowedBytes = std::uint64_t{64} << 20;
    constexpr std::uint64_t kMaxExpansion = 64;
    budgetBytes_ = kAlwaysAllowedBytes + kMaxExpansion * file.sizeBytes;
}

void Accessors::charge(std::uint64_t count, std::size_t bytesEach) {
    if (count > budgetBytes_ / bytesEach) {
        throw Error(fmt::format("{}: the scene is too large for a file of {} bytes", file_.name,
                                file_.sizeBytes));
    }
    budgetBytes_ -= count * bytesEach;
}

std::span<const unsigned char> Accessors::view(int bufferView) const {
    const auto& views = file_.model.bufferViews;
    const auto& buffers = file_.model.buffers;
    const std::string where = fmt::format("{}: buffer view {}", file_.name, bufferView);
    if (bufferView < 0 || static_cast<std::size_t>(bufferView) >= views.size()) {
        throw Error(fmt::format("{} does not exist; there are {}", where, views.size()));
    }
    const tinygltf::BufferView& view = views[static_cast<std::size_t>(bufferView)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= buffers.size()) {
        throw Error(fmt::format("{}: buffer {} does not exist; there are {}", where, view.buffer,
                                buffers.size()));
    }
    const std::span<const unsigned char> data = buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
        throw Error(fmt::format("{} reaches beyond its buffer of {} bytes", where, data.size()));
    }
    return data.subspan(view.byteOffset, view.byteLength);
}

template <int N>
std::vector<glm::vec<N, float>> Accessors::vectors(int accessor, bool mayHaveAlpha) {
    const Elements elements(*this, file_, accessor);
    if (elements.components() != N && !(mayHaveAlpha && elements.components() == N + 1)) {
        elements.fail(fmt::format("has {} components; {} are needed", elements.components(), N));
    }
    charge(elements.count(), sizeof(glm::vec<N, float>));
    std::vector<glm::vec<N, float>> values(elements.count(), glm::vec<N, float>(0.0F));
    const std::size_t bytes = componentBytes(elements.componentType());
    elements.forEach([&](std::size_t i, const unsigned char* from) {
        for (int c = 0; c < N; ++c) {
            const float value = component(from + static_cast<std::size_t>(c) * bytes,
                                          elements.componentType(), elements.isNormalized());
            if (!std::isfinite(value)) {
                elements.fail(fmt::format("element {} is not finite", i));
            }
            values[i][c] = value;
        }
    });
    return values;
}

template std::vector<glm::vec2> Accessors::vectors<2>(int, bool);
template std::vector<glm::vec3> Accessors::vectors<3>(int, bool);
template std::vector<glm::vec4> Accessors::vectors<4>(int, bool);

std::vector<std::uint32_t> Accessors::indices(int accessor) {
    const Elements elements(*this, file_, accessor);
    if (elements.components() != 1 || !isUnsigned(elements.componentType())) {
        elements.fail("does not hold indices; unsigned integers of type SCALAR are needed");
    }
    charge(elements.count(), sizeof(std::uint32_t));
    std::vector<std::uint32_t> values(elements.count(), 0);
    elements.forEach([&](std::size_t i, const unsigned char* from) {
        values[i] = unsignedInteger(from, elements.componentType());
    });
    return values;
}

}  // namespace gfxrepro::scene::gltf
