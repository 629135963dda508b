// The module: what it hands to whoever opens it.
#include "cooking/fields/openvdb/vdb.hpp"
#include "throng/version.hpp"

extern "C" __attribute__((visibility("default"))) const throng::FieldModule* throng_field_module()
{
    using namespace throng;
    static const FieldModule module{version(),  sizeof(FieldModule), vdb::fill,      vdb::surface,
                                    vdb::write, vdb::read,           vdb::read_bytes};
    return &module;
}
