// The module: what it hands to whoever opens it.
#include "cooking/fields/openvdb/vdb.hpp"
#include "throng/version.hpp"

#include <openvdb/openvdb.h>
#ifdef THRONG_PLAIN_THREADS
#include <tbb/global_control.h>
#endif

/// Starts OpenVDB, before anything is asked of it.
extern "C" const throng::FieldModule* throng_field_module()
{
#ifdef THRONG_PLAIN_THREADS
    // That build has no use for oneTBB and keeps it on the calling thread.
    static const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
#endif
    openvdb::initialize();
    namespace vdb = throng::vdb;
    static const throng::FieldModule module{throng::version(), sizeof(throng::FieldModule),
                                            vdb::fill,         vdb::surface,
                                            vdb::write,        vdb::read,
                                            vdb::read_bytes};
    return &module;
}
