#include "apps/throng/this_machine.hpp"

#include "throng/version.hpp"

#include <fstream>
#include <thread>

namespace throng {

Machine this_machine(int threads)
{
    Machine machine;
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; machine.processor.empty() && std::getline(info, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos)
            machine.processor = line.substr(colon + 2);
    }
    if (machine.processor.empty()) machine.processor = "unknown";
    std::ifstream("/proc/loadavg") >> machine.load;
    machine.version = version();
    machine.cores = std::thread::hardware_concurrency();
    machine.threads = threads;
    return machine;
}

}  // namespace throng
