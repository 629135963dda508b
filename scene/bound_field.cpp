#include "scene/bound_field.hpp"

namespace throng {
namespace {

/// What is kept of each kind of member.
template <template <class> class As, class Object>
struct Binder {
    As<Object>& object;

    template <class Value>
    PlaceOf<As> operator()(Value Object::*member) const
    {
        return &(object.*member);
    }
    PlaceOf<As> operator()(const NameOf<Object>& name) const
    {
        return NamePlaceOf<As>{&(object.*name.place), name.kind, name.or_null};
    }
    PlaceOf<As> operator()(const Bits<Object>& bits) const
    {
        return BitsPlaceOf<As>{&(object.*bits.bits)};
    }
    PlaceOf<As> operator()(const OfDial<Object>& dial) const
    {
        return std::visit([&](auto member) -> DialPlaceOf<As> { return &(object.*member); },
                          dial.value);
    }
    PlaceOf<As> operator()(const Group<Object>& group) const { return all(group.fields); }
    PlaceOf<As> operator()(ByHand by_hand) const { return by_hand; }

    BoundFieldsOf<As> all(Fields<Object> fields) const
    {
        BoundFieldsOf<As> bound;
        bound.reserve(fields.size());
        for (const Field<Object>& field : fields)
            bound.push_back({&field, std::visit(*this, field.member)});
        return bound;
    }
};

}  // namespace

template <class Object>
BoundFields bound(const Object& object, Fields<Object> fields)
{
    return Binder<ToRead, Object>{object}.all(fields);
}
template <class Object>
WritableFields writable(Object& object, Fields<Object> fields)
{
    return Binder<ToWrite, Object>{object}.all(fields);
}

// Of every object that fields.hpp has a table of.
#define THRONG_BIND(Object)                                                                        \
    template BoundFields bound(const Object&, Fields<Object>);                                     \
    template WritableFields writable(Object&, Fields<Object>)

THRONG_BIND(Scene);
THRONG_BIND(Material);
THRONG_BIND(MaterialPairDescription);
THRONG_BIND(SphereShape);
THRONG_BIND(CapsuleShape);
THRONG_BIND(CylinderShape);
THRONG_BIND(BoxShape);
THRONG_BIND(HullShape);
THRONG_BIND(PlaneShape);
THRONG_BIND(MeshShape);
THRONG_BIND(VoxelsShape);
THRONG_BIND(CompoundShape);
THRONG_BIND(CompoundShape::Part);
THRONG_BIND(Pose);
THRONG_BIND(BodyDescription);
THRONG_BIND(Instances);
THRONG_BIND(Spring);
THRONG_BIND(Attractor);

#undef THRONG_BIND

}  // namespace throng
