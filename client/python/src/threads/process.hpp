// The process in which this package was used first: threads of its libraries do not survive a fork.
#pragma once

#include <memory>
#include <stdexcept>
#include <utility>

namespace meniscus::python {

/// Raised as meniscus.ForkedError.
class ForkedError : public std::runtime_error {
public:
    ForkedError();
};

/// At the beginning of every call that computes or talks to a server. Throws ForkedError in a process that was forked
/// after the first such call. What was made before the fork must not be destroyed there either: see OwnProcessDelete.
void require_own_process();
/// Whether this process was forked after the first such call.
bool is_forked() noexcept;

/// The deleter of what has threads, or shares some: in a forked process it destroys nothing, for that would wait for
/// threads that are not there. It also serves in the holder of a class: std::unique_ptr<T, OwnProcessDelete<T>>.
template <class T>
struct OwnProcessDelete {
    void operator()(T* content) const noexcept {
        if (!is_forked()) delete content;
    }
};

/// Makes a shared object as std::make_shared does, with this deleter.
template <class T, class... Arguments>
std::shared_ptr<T> make_in_process(Arguments&&... arguments) {
    return std::shared_ptr<T>(new T(std::forward<Arguments>(arguments)...), OwnProcessDelete<T>());
}

}  // namespace meniscus::python
