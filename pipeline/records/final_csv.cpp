// Final CSV: where every body is and how it moves, for programs that compare runs.
#include "throng/final_csv.hpp"

#include <array>
#include <charconv>

namespace throng {
namespace {

void append_number(double number, std::string& line)
{
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    line += ',';
    line.append(digits.data(), end);
}

void append_vector(const Vec3& v, std::string& line)
{
    for (const double number : {v.x(), v.y(), v.z()}) append_number(number, line);
}

void append_name(const std::string& name, std::string& line)
{
    line += ',';
    if (name.find_first_of(",\"\r\n") == std::string::npos) {
        line += name;
        return;
    }
    line += '"';
    for (const char letter : name) {
        if (letter == '"') line += '"';
        line += letter;
    }
    line += '"';
}

}  // namespace

void write_final_csv(const World& world, std::ostream& out)
{
    out << "id,name,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
    std::string line;
    for (const BodyId body : world.bodies()) {
        const Pose pose = world.pose(body);
        const Quat& turn = pose.orientation;
        line = std::to_string(body.index);
        append_name(world.name(body), line);
        append_vector(pose.position, line);
        for (const double number : {turn.w(), turn.x(), turn.y(), turn.z()})
            append_number(number, line);
        append_vector(world.velocity(body), line);
        append_vector(world.angular_velocity(body), line);
        out << line << '\n';
    }
}

}  // namespace throng
