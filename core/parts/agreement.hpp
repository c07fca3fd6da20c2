// What processes tell each other, with the error of one of them in place of what it would have told: then all fail
// together, and none waits for it.
#pragma once

#include <concepts>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "meniscus/parts.hpp"

namespace meniscus {

class Agreement {
public:
    using Bytes = PartExchange::Bytes;

    /// exchange: must stay.
    explicit Agreement(PartExchange& exchange) : exchange_(exchange) {}
    std::size_t rank() const { return exchange_.rank(); }
    std::size_t ranks() const { return exchange_.ranks(); }

    /// As PartExchange::gather() of what make() returns. Where make() throws in one process, all throw: ProcessFailed,
    /// or InvalidInput or LimitExceeded if it was one of these, with that process's number; a process by itself throws
    /// what it was.
    template <std::invocable Make>
    std::vector<Bytes> gather(const Make& make) {
        Bytes mine;
        try {
            mine = make();
            mine.push_back(no_error);
        } catch (...) {
            mine = failure_of(std::current_exception());
        }
        std::vector<Bytes> all = exchange_.gather(std::move(mine));
        open(all);
        return all;
    }
    /// As PartExchange::all_to_all(), of what make() writes to `to`; throws likewise.
    template <std::invocable Make>
    void all_to_all(std::vector<Bytes>& to, std::vector<Bytes>& from, const Make& make) {
        try {
            make();
            for (Bytes& bytes : to) bytes.push_back(no_error);
        } catch (...) {
            to.assign(ranks(), failure_of(std::current_exception()));
        }
        exchange_.all_to_all(to, from);
        open(from);
    }
    /// Waits until all have done this, and throws likewise.
    template <std::invocable Act>
    void agree(const Act& act) {
        gather([&] {
            act();
            return Bytes();
        });
    }

private:
    static constexpr std::byte no_error{0};

    /// Its text, and its kind behind it. A process by itself throws it.
    Bytes failure_of(const std::exception_ptr& error) const;
    /// Takes away what was behind each, or throws it.
    static void open(std::vector<Bytes>& from);

    PartExchange& exchange_;
};

}  // namespace meniscus
