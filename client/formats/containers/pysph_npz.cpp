#include "formats/containers/pysph_npz.hpp"

#include <limits>
#include <optional>
#include <string>

#include "formats/containers/array_collector.hpp"
#include "formats/containers/pickle.hpp"

namespace meniscus::formats {
namespace {

using Value = Pickle::Value;
using Kind = Pickle::Kind;

bool is_call_of(const Pickle& pickle, const Value& value, std::string_view name) {
    const Value* called = value.kind == Kind::object ? pickle.item(value, 0) : nullptr;
    return called != nullptr && called->kind == Kind::global && called->text == name;
}

/// "<f8": of numpy.dtype('f8', False, True) with the state (3, '<', ...).
std::optional<std::string> type_name(const Pickle& pickle, const Value& value) {
    if (!is_call_of(pickle, value, "dtype")) return std::nullopt;
    const Value* arguments = pickle.item(value, 1);
    const Value* state = pickle.item(value, 2);
    const Value* name = arguments == nullptr ? nullptr : pickle.item(*arguments, 0);
    const Value* order = state == nullptr ? nullptr : pickle.item(*state, 1);
    constexpr std::size_t most_bytes = 16;  // of numpy's names of types: a text may be of any size, for each array
    if (name == nullptr || name->text.size() > most_bytes) return std::nullopt;
    if (order != nullptr && order->text.size() > most_bytes) return std::nullopt;
    return std::string(order == nullptr ? std::string_view("|") : order->text) + std::string(name->text);
}

/// The state of a numpy array: (version, shape, type, whether in Fortran's order, data).
struct ArrayState {
    const Value* shape;
    const Value* type;
    const Value* fortran;
    const Value* data;
};

std::optional<ArrayState> array_state(const Pickle& pickle, const Value& value) {
    const Value* state = is_call_of(pickle, value, "_reconstruct") ? pickle.item(value, 2) : nullptr;
    if (state == nullptr || state->items.size() != 5) return std::nullopt;
    const auto part = [&](std::size_t i) { return &pickle[state->items[i]]; };
    return ArrayState{part(1), part(2), part(3), part(4)};
}

NpyArray numpy_array(const ByteCursor& at, const Pickle& pickle, std::string_view name, const Value& value) {
    const auto state = array_state(pickle, value);
    const auto type = state ? type_name(pickle, *state->type) : std::nullopt;
    NpyArray array;
    if (!type || state->data->kind != Kind::bytes) {
        array.unread = "no array of numbers";
        return array;
    }
    if (state->shape->items.size() > most_dimensions)
        at.fail("array " + quoted(name) + " has a shape of " + std::to_string(state->shape->items.size()) +
                " sizes; arrays have at most " + std::to_string(most_dimensions));
    for (const Pickle::Id size : state->shape->items) {
        const Value& edge = pickle[size];
        if (edge.kind != Kind::integer || edge.number < 0)
            at.fail("array " + quoted(name) + " has a shape that is none");
        array.shape.push_back(static_cast<std::size_t>(edge.number));
    }
    array.fortran = state->fortran->number != 0;
    set_npy_type(array, *type);
    if (!array.unread.empty()) return array;
    std::size_t bytes = size_of(array.type);
    for (const std::size_t size : array.shape)
        if (__builtin_mul_overflow(bytes, size, &bytes)) bytes = std::numeric_limits<std::size_t>::max();
    if (bytes != state->data->text.size())
        at.fail("array " + quoted(name) + " of shape " + shape_text(array.shape) + " has " +
                std::to_string(state->data->text.size()) + " bytes");
    array.data = state->data->text;
    return array;
}

/// The dictionary in the array of one object that numpy pickles.
const Value* dictionary(const Pickle& pickle) {
    const auto state = array_state(pickle, pickle[pickle.root()]);
    return state ? pickle.item(*state->data, 0) : nullptr;
}

/// The kind of particles that is read.
const Value& kind_of_particles(const ByteCursor& at, const Pickle& pickle) {
    const Value* kinds = dictionary(pickle);
    if (kinds == nullptr || kinds->kind != Kind::mapping || kinds->items.size() < 2)
        at.fail(
            "holds pickled objects that are not PySPH's particles: save plain arrays, as numpy.savez(FILE, "
            "positions=..., velocity=...)");
    if (const Value* fluid = pickle.find(*kinds, "fluid")) return *fluid;
    if (kinds->items.size() > 2)
        at.fail("holds " + std::to_string(kinds->items.size() / 2) +
                " kinds of particles, none of them named 'fluid': save the one to be shown as plain arrays, as "
                "numpy.savez(FILE, positions=..., velocity=...)");
    return *pickle.item(*kinds, 1);
}

}  // namespace

std::vector<NamedNpyArray> pysph_arrays(const ByteCursor& at, std::string_view pickled, ReadBudget& budget) {
    const Pickle pickle(at, pickled, budget);
    const Value* arrays = pickle.find(kind_of_particles(at, pickle), "arrays");
    if (arrays == nullptr) at.fail("holds PySPH's particles without their arrays");
    if (arrays->items.size() / 2 > most_arrays)
        at.fail("holds " + std::to_string(arrays->items.size() / 2) + " arrays; at most " +
                std::to_string(most_arrays) + " are read");
    std::vector<NamedNpyArray> out;
    for (std::size_t i = 0; i + 1 < arrays->items.size(); i += 2) {
        const std::string_view name = pickle.item(*arrays, i)->text;
        out.push_back({name, numpy_array(at, pickle, name, *pickle.item(*arrays, i + 1))});
    }
    return out;
}

}  // namespace meniscus::formats
