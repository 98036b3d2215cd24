#include "tungsten/reader/FormatTypes.h"

#include "tungsten/core/Errors.h"

namespace tungsten {

const Instead& unsupportedMedia() {
    static const std::string what =
        "media are homogeneous; where coefficients vary, use homogeneous ones in bodies within "
        "one another";
    static const Instead types{{"exponential", what}, {"atmosphere", what},    {"voxel", what},        {"vdb", what},
                               {"grid", what},        {"heterogeneous", what}, {"inhomogeneous", what}};
    return types;
}

const Instead& unsupportedTransmittances() {
    static const std::string what = "light dies away exponentially; use exponential";
    static const Instead types{{"linear", what}, {"quadratic", what},   {"double_exponential", what},
                               {"erlang", what}, {"davis", what},       {"davis_weinstein", what},
                               {"pulse", what},  {"interpolated", what}};
    return types;
}

const Instead& unsupportedBsdfs() {
    static const std::string fibre = "it is made for fibres, of which there are none; use ";
    static const Instead types{{"phong", "use rough_plastic"},
                               {"smooth_coat", "use plastic, a coat over a diffuse base"},
                               {"rough_coat", "use rough_plastic, a coat over a diffuse base"},
                               {"thinsheet", "use two surfaces of dielectric, or transparency over a mirror"},
                               {"diffuse_transmission", "use a thin body of a medium that scatters"},
                               {"hair", fibre + "rough_plastic"},
                               {"lambertian_fiber", fibre + "lambert"},
                               {"rough_wire", fibre + "rough_conductor"}};
    return types;
}

const Instead& unsupportedMetals() {
    static const Instead metals = [] {
        Instead all;
        for (const char* name : {"a-C", "AlAs", "AlSb", "Be",   "CsI", "Cu2O", "CuO",  "d-C",    "Hg",   "HgTe", "Ir",
                                 "K",   "MgO",  "Mo",   "Na",   "Nb",  "Ni",   "Rh",   "Se",     "Se-e", "SiC",  "SnTe",
                                 "Ta",  "Te",   "Te-e", "ThF4", "TiC", "TiN",  "TiO2", "TiO2-e", "V",    "VC",   "W"})
            all.emplace(name, "give its eta and k");
        return all;
    }();
    return metals;
}

const Instead& unsupportedTextures() {
    static const Instead types{
        {"disk", "use a bitmap"}, {"blade", "use a bitmap"}, {"ies", "use a spot, whose cone has a smooth edge"}};
    return types;
}

const Instead& unsupportedPrimitives() {
    static const Instead types{{"cylinder", "use a mesh"},
                               {"infinite_sphere_cap", "use an infinite_sphere with a bitmap, or a disk far away"},
                               {"skydome", "use an infinite_sphere with a bitmap"},
                               {"instances", "use a mesh for each copy"},
                               {"curves", "use a mesh"},
                               {"minecraft_map", "use a mesh"}};
    return types;
}

const Instead& unsupportedCameras() {
    static const Instead types{{"equirectangular", "use several of pinhole"},
                               {"cubemap", "use six of pinhole with a fov of 90"}};
    return types;
}

const Instead& unsupportedIntegrators() {
    static const std::string what =
        "use path_tracer, or progressive_photon_map where light comes through mirrors or glass";
    static const Instead types{{"bidirectional_path_tracer", what},
                               {"kelemen_mlt", what},
                               {"multiplexed_mlt", what},
                               {"reversible_jump_mlt", what}};
    return types;
}

std::string refusal(const std::string& type, const std::string& found, const std::vector<std::string>& supported,
                    const Instead& instead) {
    const auto known = instead.find(type);
    if (known != instead.end())
        return "'" + type + "' is not supported: " + known->second + "; supported: " + listOf(supported);
    const std::string near = nearestName(type, supported);
    return (supported.empty() ? "there is none to choose from" : "expected " + listOf(supported)) + ", found " + found +
           (near.empty() ? "" : "; did you mean '" + near + "'?");
}

} // namespace tungsten
