#include <cattaneo/friction/contact_state_json.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <filesystem>
#include <fstream>

namespace cattaneo
{

namespace
{

const char *const format_name = "cattaneo contact state 1";

} // namespace

std::vector<double> json_list(const Eigen::VectorXd &x)
{
   return {x.data(), x.data() + x.size()};
}

Eigen::VectorXd json_vector(const nlohmann::json &j)
{
   const auto values = j.get<std::vector<double>>();
   return Eigen::Map<const Eigen::VectorXd>(values.data(), values.size());
}

nlohmann::json to_json(const ContactState &state)
{
   state.require_finite(); // else it would be written as null
   std::vector<int> status;
   for (NodeState s : state.status) { status.push_back(static_cast<int>(s)); }
   std::vector<std::vector<double>> cycle_slip;
   for (const Eigen::VectorXd &v : state.cycle_slip) { cycle_slip.push_back(json_list(v)); }
   return {{"format", format_name},
           {"time", state.time},
           {"step", state.step},
           {"peak_force", state.peak_force},
           {"dissipation", state.dissipation},
           {"multipliers", json_list(state.multipliers)},
           {"status", status},
           {"cycle_slip", cycle_slip},
           {"slip_origin", json_list(state.slip_origin)},
           {"v", json_list(state.v)},
           {"w", json_list(state.w)},
           {"q", json_list(state.q)},
           {"p", json_list(state.p)}};
}

ContactState contact_state(const nlohmann::json &j, const std::string &file)
{
   ContactState state;
   state.time = j.at("time");
   state.step = j.at("step");
   state.peak_force = j.at("peak_force");
   state.dissipation = j.at("dissipation");
   state.multipliers = json_vector(j.at("multipliers"));
   for (int s : j.at("status").get<std::vector<int>>())
   {
      require(s >= 0 && s <= 4, "contact state: status ", s, " in file '", file,
              "', must be 0 to 4");
      state.status.push_back(static_cast<NodeState>(s));
   }
   for (const nlohmann::json &v : j.at("cycle_slip"))
   {
      state.cycle_slip.push_back(json_vector(v));
   }
   state.slip_origin = json_vector(j.at("slip_origin"));
   state.v = json_vector(j.at("v"));
   state.w = json_vector(j.at("w"));
   state.q = json_vector(j.at("q"));
   state.p = json_vector(j.at("p"));
   return state;
}

void read_state_file(const std::string &what, const std::string &file,
                     const std::string &format,
                     const std::function<void(const nlohmann::json &)> &read)
{
   std::ifstream in(file);
   require(in.good() && !std::filesystem::is_directory(file), what, ": cannot read file '",
           file, "'");
   try
   {
      const nlohmann::json j = nlohmann::json::parse(in);
      require(j.at("format") == format, what, ": file '", file, "' has format ",
              j.at("format").dump(), ", must be \"", format, "\"");
      read(j);
   }
   catch (const nlohmann::json::exception &e)
   {
      throw InputError(what + ": file '" + file + "' is not a " + what + ": " + e.what());
   }
}

void save(const ContactState &state, const std::string &file)
{
   write_whole(file, to_json(state).dump(1) + '\n');
}

ContactState load_contact_state(const std::string &file)
{
   ContactState state;
   read_state_file("contact state", file, format_name,
                   [&](const nlohmann::json &j) { state = contact_state(j, file); });
   return state;
}

} // namespace cattaneo
