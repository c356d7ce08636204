#include "engine/gl/work_query.h"

namespace gfxrepro::gl {

namespace {
constexpr GLenum kWorkTargets[] = {GL_PRIMITIVES_SUBMITTED, GL_FRAGMENT_SHADER_INVOCATIONS,
                                   GL_COMPUTE_SHADER_INVOCATIONS};
}  // namespace

WorkQuery::WorkQuery(bool isSupported) {
    for (std::size_t i = 0; isSupported && i < names_.size(); ++i) {
        GLuint id = 0;
        glGenQueries(1, &id);  // Mesa 22.3's glCreateQueries does not know these targets
        names_[i] = detail::Name<detail::deleteQuery>(id);
    }
}

void WorkQuery::begin() const {
    for (std::size_t i = 0; names_[0].get() != 0 && i < names_.size(); ++i) {
        glBeginQuery(kWorkTargets[i], names_[i].get());
    }
}

void WorkQuery::end() const {
    for (std::size_t i = 0; names_[0].get() != 0 && i < names_.size(); ++i) {
        glEndQuery(kWorkTargets[i]);
    }
}

std::optional<Work> WorkQuery::result() const {
    if (names_[0].get() == 0) return std::nullopt;
    GLuint64 counts[3] = {};
    for (std::size_t i = 0; i < names_.size(); ++i) {
        glGetQueryObjectui64v(names_[i].get(), GL_QUERY_RESULT, &counts[i]);
    }
    return Work{counts[0], counts[1], counts[2]};
}

}  // namespace gfxrepro::gl
