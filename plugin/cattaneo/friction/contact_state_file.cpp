#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace cattaneo
{

namespace
{

const char *const format_name = "cattaneo contact state 1";

std::vector<double> list(const Eigen::VectorXd &x)
{
   return {x.data(), x.data() + x.size()};
}

Eigen::VectorXd vector(const nlohmann::json &j)
{
   const auto values = j.get<std::vector<double>>();
   return Eigen::Map<const Eigen::VectorXd>(values.data(), values.size());
}

} // namespace

void save(const ContactState &state, const std::string &file)
{
   state.require_finite(); // else it would be written as null
   std::vector<int> status;
   for (NodeState s : state.status) { status.push_back(static_cast<int>(s)); }
   std::vector<std::vector<double>> cycle_slip;
   for (const Eigen::VectorXd &v : state.cycle_slip) { cycle_slip.push_back(list(v)); }
   const nlohmann::json j = {{"format", format_name},
                             {"time", state.time},
                             {"step", state.step},
                             {"peak_force", state.peak_force},
                             {"dissipation", state.dissipation},
                             {"multipliers", list(state.multipliers)},
                             {"status", status},
                             {"cycle_slip", cycle_slip},
                             {"slip_origin", list(state.slip_origin)},
                             {"v", list(state.v)},
                             {"w", list(state.w)},
                             {"q", list(state.q)},
                             {"p", list(state.p)}};
   write_whole(file, j.dump(1) + '\n');
}

ContactState load_contact_state(const std::string &file)
{
   std::ifstream in(file);
   require(in.good() && !std::filesystem::is_directory(file),
           "contact state: cannot read file '", file, "'");
   try
   {
      const nlohmann::json j = nlohmann::json::parse(in);
      require(j.at("format") == format_name, "contact state: file '", file, "' has format ",
              j.at("format").dump(), ", must be \"", format_name, "\"");
      ContactState state;
      state.time = j.at("time");
      state.step = j.at("step");
      state.peak_force = j.at("peak_force");
      state.dissipation = j.at("dissipation");
      state.multipliers = vector(j.at("multipliers"));
      for (int s : j.at("status").get<std::vector<int>>())
      {
         require(s >= 0 && s <= 4, "contact state: status ", s, " in file '", file,
                 "', must be 0 to 4");
         state.status.push_back(static_cast<NodeState>(s));
      }
      for (const nlohmann::json &v : j.at("cycle_slip"))
      {
         state.cycle_slip.push_back(vector(v));
      }
      state.slip_origin = vector(j.at("slip_origin"));
      state.v = vector(j.at("v"));
      state.w = vector(j.at("w"));
      state.q = vector(j.at("q"));
      state.p = vector(j.at("p"));
      return state;
   }
   catch (const nlohmann::json::exception &e)
   {
      throw InputError("contact state: file '" + file +
                       "' is not a contact state: " + e.what());
   }
}

} // namespace cattaneo
