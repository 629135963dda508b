// Bound field: a field together with the member of one object, the object's type forgotten.
//
// Whoever goes through the fields of all kinds of objects does it here once for each kind of
// member, and not once more for each kind of object.
#pragma once

#include "scene/fields.hpp"

namespace throng {

template <template <class> class As>
struct BoundFieldOf;
template <template <class> class As>
using BoundFieldsOf = std::vector<BoundFieldOf<As>>;

/// Where members are kept, as they are looked at: `As<double>` is `double` or `const double`. See
/// field.hpp, which has the same of members of objects.
template <template <class> class As>
struct NamePlaceOf {
    As<std::uint32_t>* place;
    Named kind;
    bool or_null;
};
template <template <class> class As>
struct BitsPlaceOf {
    As<std::uint32_t>* bits;
};
template <template <class> class As>
using DialPlaceOf = std::variant<As<double>*, As<int>*, As<std::string>*>;
template <template <class> class As>
using PlaceOf = std::variant<As<double>*,
                             As<std::optional<double>>*,
                             As<Vec3>*,
                             As<std::optional<Vec3>>*,
                             As<std::vector<Vec3>>*,
                             As<std::optional<Sym3>>*,
                             As<Quat>*,
                             As<bool>*,
                             As<std::uint64_t>*,
                             As<std::string>*,
                             As<Motion>*,
                             As<std::array<std::optional<double>, 3>>*,
                             NamePlaceOf<As>,
                             BitsPlaceOf<As>,
                             DialPlaceOf<As>,
                             BoundFieldsOf<As>,
                             ByHand>;

/// Of a table: it outlives neither that nor the object.
template <template <class> class As>
struct BoundFieldOf {
    const FieldWords* words;
    PlaceOf<As> place;
};

template <class Value>
using ToRead = const Value;
template <class Value>
using ToWrite = Value;

using BoundName = NamePlaceOf<ToRead>;
using BoundBits = BitsPlaceOf<ToRead>;
using BoundDial = DialPlaceOf<ToRead>;
using BoundField = BoundFieldOf<ToRead>;
using BoundFields = BoundFieldsOf<ToRead>;

using WritableName = NamePlaceOf<ToWrite>;
using WritableBits = BitsPlaceOf<ToWrite>;
using WritableDial = DialPlaceOf<ToWrite>;
using WritableFields = BoundFieldsOf<ToWrite>;

/// The fields of a table, each with its member of the object.
template <class Object>
BoundFields bound(const Object& object, Fields<Object> fields);
template <class Object>
WritableFields writable(Object& object, Fields<Object> fields);

}  // namespace throng
