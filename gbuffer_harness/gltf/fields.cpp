#include "gltf/fields.h"

#include <algorithm>
#include <map>

#include "common/error.h"
#include "common/parse.h"

namespace pellucid::harness {

namespace {

constexpr FieldUse kUsed = FieldUse::Used, kNoEffect = FieldUse::NoEffect, kNear = FieldUse::Approximated,
                   kLeftOut = FieldUse::LeftOut, kRefused = FieldUse::Refused;

}  // namespace

const std::vector<GltfField>& gltfFields() {
  static const std::vector<GltfField> fields = {
      {"scene,extensionsUsed,extensionsRequired", kUsed},
      {"asset.**", kNoEffect, "says who wrote the file"},
      {"scenes.*.nodes", kUsed},
      {"nodes.*.children,mesh,skin,camera,matrix,translation,rotation,scale,weights", kUsed},
      {"meshes.*.weights", kUsed},
      {"meshes.*.primitives.*.indices,material,mode", kUsed},
      {"meshes.*.primitives.*.attributes.POSITION,NORMAL,TANGENT,TEXCOORD_n,COLOR_0,JOINTS_n,WEIGHTS_n,_"
       "TRANSLUCENT",
       kUsed},
      {"meshes.*.primitives.*.attributes.COLOR_n", kLeftOut, "colors beyond the first are left out"},
      {"meshes.*.primitives.*.attributes._*", kNoEffect, "belongs to an application"},
      {"meshes.*.primitives.*.targets.*.POSITION,NORMAL,TANGENT", kUsed},
      {"meshes.*.primitives.*.targets.*.TEXCOORD_n,COLOR_n", kLeftOut,
       "morph targets move no colors and textures"},
      {"skins.*.joints", kNear, "skinned meshes stand in the pose that nodes have in the file"},
      {"skins.*.inverseBindMatrices", kUsed},
      {"skins.*.skeleton", kNoEffect, "joints have their own places"},
      {"animations.**", kLeftOut, "animations are left out: nodes stand in their rest pose"},
      {"accessors.*.bufferView,byteOffset,componentType,normalized,count,type", kUsed},
      {"accessors.*.sparse.**", kUsed},
      {"accessors.*.min,max", kNoEffect, "the values say it"},
      {"bufferViews.*.buffer,byteOffset,byteLength,byteStride", kUsed},
      {"bufferViews.*.target", kNoEffect, "of OpenGL"},
      {"buffers.*.uri,byteLength", kUsed},
      {"cameras.*.type", kUsed},
      {"cameras.*.perspective.yfov,znear,zfar,aspectRatio", kUsed},
      {"cameras.*.orthographic.xmag,ymag,znear,zfar", kUsed},
      {"images.*.uri,bufferView", kUsed},
      {"images.*.mimeType", kNoEffect, "the bytes say it"},
      {"textures.*.source,sampler", kUsed},
      {"samplers.*.wrapS,wrapT", kUsed},
      {"samplers.*.minFilter", kNoEffect, "one texel of the full image is interpolated for each pixel"},
      {"samplers.*.magFilter", kNear, "texels are interpolated, not the nearest taken", "9729"},
      {"materials.*.alphaMode,alphaCutoff,doubleSided", kUsed},
      {"materials.*.pbrMetallicRoughness.baseColorFactor", kUsed},
      {"materials.*.pbrMetallicRoughness.baseColorTexture.index,texCoord", kUsed},
      {"materials.*.pbrMetallicRoughness.metallicFactor,roughnessFactor", kNoEffect,
       "of specular light; a medium is no metal"},
      {"materials.*.pbrMetallicRoughness.metallicRoughnessTexture.**", kNoEffect,
       "of specular light; a medium is no metal"},
      {"materials.*.normalTexture.index,texCoord,scale", kUsed},
      {"materials.*.occlusionTexture.**", kNoEffect, "the traced irradiance has the shadows of the mesh"},
      {"materials.*.emissiveFactor", kLeftOut, "its glow lights nothing; --light adds a light", "[0, 0, 0]"},
      {"materials.*.emissiveTexture.**", kNoEffect, "multiplies emissiveFactor"},

      {"EXT_meshopt_compression.buffer,byteOffset,byteLength,byteStride,count,mode,filter,fallback", kUsed},
      {"KHR_lights_punctual.light", kUsed},
      {"KHR_lights_punctual.lights.*.type,color,intensity,range", kUsed},
      {"KHR_lights_punctual.lights.*.spot.innerConeAngle,outerConeAngle", kUsed},
      {"KHR_materials_diffuse_transmission.diffuseTransmissionFactor,diffuseTransmissionColorFactor", kUsed},
      {"KHR_materials_diffuse_transmission.diffuseTransmissionTexture,diffuseTransmissionColorTexture.index,"
       "texCoord",
       kUsed},
      {"KHR_materials_ior.ior", kUsed},
      {"KHR_materials_transmission.transmissionFactor", kUsed},
      {"KHR_materials_transmission.transmissionTexture.**", kNear, "transmissionFactor holds everywhere"},
      {"KHR_materials_volume.thicknessFactor,attenuationDistance,attenuationColor", kUsed},
      {"KHR_materials_volume.thicknessTexture.**", kNoEffect, "the mesh has the thickness"},
      {"KHR_materials_volume_scatter.multiscatterColorFactor,multiscatterColor,scatterAnisotropy", kUsed},
      {"KHR_materials_volume_scatter.multiscatterColorTexture.index,texCoord", kUsed},
      {"KHR_node_visibility.visible", kUsed},
      {"KHR_texture_transform.offset,rotation,scale,texCoord", kUsed},
  };
  return fields;
}

const std::vector<GltfExtension>& gltfExtensions() {
  static const std::vector<GltfExtension> extensions = {
      {"EXT_meshopt_compression", kUsed, "", "buffers,bufferViews"},
      {"KHR_lights_punctual", kUsed, "", "extensions,nodes"},
      {"KHR_materials_diffuse_transmission", kUsed, "", "materials"},
      {"KHR_materials_ior", kUsed, "", "materials"},
      {"KHR_materials_transmission", kUsed, "", "materials"},
      {"KHR_materials_volume", kUsed, "", "materials"},
      {"KHR_materials_volume_scatter", kUsed, "", "materials"},
      {"KHR_mesh_quantization", kUsed},
      {"KHR_node_visibility", kUsed, "", "nodes"},
      {"KHR_texture_transform", kUsed, "", "materials"},
      {"KHR_animation_pointer", kNoEffect, "of animations"},
      {"KHR_materials_anisotropy", kNoEffect, "of specular light"},
      {"KHR_materials_clearcoat", kNoEffect, "of specular light"},
      {"KHR_materials_dispersion", kNoEffect, "of specular light"},
      {"KHR_materials_emissive_strength", kNoEffect, "multiplies emissiveFactor"},
      {"KHR_materials_iridescence", kNoEffect, "of specular light"},
      {"KHR_materials_specular", kNoEffect, "of specular light"},
      {"KHR_node_hoverability", kNoEffect, "of interaction"},
      {"KHR_node_selectability", kNoEffect, "of interaction"},
      {"KHR_xmp_json_ld", kNoEffect, "says who wrote the file"},
      {"EXT_lights_ies", kLeftOut, "the light has no profile; a manifest's angleTable holds one"},
      {"EXT_lights_image_based", kLeftOut, "its sky is left out; --environment adds one"},
      {"KHR_materials_sheen", kLeftOut, "the dark of cloth below its sheen is left out"},
      {"KHR_materials_unlit", kLeftOut, "it is lit, unless it surrounds a light"},
      {"KHR_materials_variants", kLeftOut, "the default look is drawn; export another one alone"},
      {"EXT_mesh_gpu_instancing", kRefused,
       "its instances are not drawn; import it into Blender, and export real copies"},
      {"EXT_texture_avif", kRefused, "`gltf-transform png in.glb out.glb` makes PNG files"},
      {"EXT_texture_webp", kRefused, "`gltf-transform png in.glb out.glb` makes PNG files"},
      {"KHR_draco_mesh_compression", kRefused, "`gltf-transform copy in.glb out.glb` decompresses"},
      {"KHR_materials_pbrSpecularGlossiness", kRefused,
       "`gltf-transform metalrough in.glb out.glb` writes base colors"},
      {"KHR_texture_basisu", kRefused, "`gltf-transform ktxdecompress in.glb out.glb` makes PNG files"},
      {"MSFT_texture_dds", kRefused, "`gltf-transform png in.glb out.glb` makes PNG files"},
  };
  return extensions;
}

namespace {

const GltfExtension* extensionNamed(const std::string& name) {
  const std::vector<GltfExtension>& all = gltfExtensions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& e) { return e.name == name; });
  return found == all.end() ? nullptr : &*found;
}

// TEXCOORD_n for TEXCOORD_3: sets are numbered.
std::string withoutNumber(const std::string& key) {
  const std::size_t end = key.find_last_not_of("0123456789");
  return end != std::string::npos && end + 1 < key.size() && key[end] == '_' ? key.substr(0, end + 1) + "n"
                                                                             : key;
}

bool fitsKey(const std::string& step, const std::string& key) {
  for (const std::string& name : split(step, ',')) {
    const bool begins =
        name.size() > 1 && name.back() == '*' && key.rfind(name.substr(0, name.size() - 1), 0) == 0;
    if (name == "*" || name == key || name == withoutNumber(key) || begins) return true;
  }
  return false;
}

enum class Fit { No, Below, Whole };  // Below: the path leads to the rule's

Fit fit(const std::vector<std::string>& rule, const std::vector<std::string>& path) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i == rule.size()) return Fit::No;
    if (rule[i] == "**") return Fit::Whole;
    if (!fitsKey(rule[i], path[i])) return Fit::No;
  }
  return path.size() == rule.size() ? Fit::Whole : Fit::Below;
}

// Walks over a file's JSON, and keeps a sentence of each kind of field.
class Walk {
public:
  void object(const GltfJson& value, const std::string& place, const std::vector<std::string>& path) {
    for (const auto& [key, element] : value.items()) {
      if (key == "extras" || key == "name") continue;
      std::vector<std::string> below = path;
      below.push_back(key);
      const std::string where = place.empty() ? key : place + "." + key;
      if (key == "extensions" && element.is_object())
        extensions(element, where);
      else
        field(element, where, below);
    }
  }

  void used(const std::string& name) {
    const GltfExtension* known = extensionNamed(name);
    if (!known)
      add(name, "extension " + name + " is not known, and what it says is left out");
    else if (known->use != kUsed && known->use != kNoEffect)
      add(name, "extension " + name + ": " + known->sentence);
  }

  std::vector<std::string> sentences() const {
    std::vector<std::string> result;
    for (const std::string& kind : order_) {
      const auto& [sentence, count] = found_.at(kind);
      const bool isExtension = sentence.rfind("extension ", 0) == 0;
      result.push_back(sentence +
                       (count > 1 && !isExtension ? " (and " + std::to_string(count - 1) + " more)" : ""));
    }
    return result;
  }

private:
  void extensions(const GltfJson& value, const std::string& place) {
    for (const auto& [name, element] : value.items()) {
      const GltfExtension* known = extensionNamed(name);
      const bool isUsed = known && known->use == kUsed;
      if (isUsed && !fitsKey(known->places, place.substr(0, place.find_first_of("[."))))
        add(name + " there", place + "." + name + ": objects there do not have this extension, and what it says is left out");
      else if (isUsed)
        field(element, place + "." + name, {name});
      else
        used(name);
    }
  }

  struct Known {
    const GltfField* rule = nullptr;
    bool leads = false;  // to rules below
  };

  void field(const GltfJson& value, const std::string& place, const std::vector<std::string>& path) {
    std::string kind;
    for (const std::string& key : path) kind += "." + key;
    const auto [entry, isNew] = known_.try_emplace(kind);
    if (isNew) entry->second = knownAt(path);
    const auto [rule, leads] = entry->second;
    if (rule) {
      // A number 0 may be an index: only the list knows values that say nothing.
      const bool says = rule->use != kUsed && rule->use != kNoEffect &&
                        (!*rule->silent || value != GltfJson::parse(rule->silent));
      if (says) add(rule->path, place + ": " + rule->sentence);
    } else if (leads && value.is_object()) {
      object(value, place, path);
    } else if (leads && value.is_array()) {
      std::vector<std::string> below = path;
      below.push_back("*");
      for (std::size_t i = 0; i < value.size(); ++i)
        field(value[i], place + "[" + std::to_string(i) + "]", below);
    } else {
      add(kind, place + ": the field is not known, and what it says is left out");
    }
  }

  static Known knownAt(const std::vector<std::string>& path) {
    Known known;
    for (const GltfField& rule : gltfFields()) {
      const Fit found = fit(split(rule.path, '.'), path);
      known.leads = known.leads || found == Fit::Below;
      if (found == Fit::Whole && !known.rule) known.rule = &rule;
    }
    return known;
  }

  // Files have most kinds many times: the first is named, and the others are counted.
  void add(const std::string& kind, const std::string& sentence) {
    const auto [entry, isNew] = found_.try_emplace(kind, sentence, 0);
    if (isNew) order_.push_back(kind);
    ++entry->second.second;
  }

  std::map<std::string, Known> known_;  // of the kinds that were met
  std::vector<std::string> order_;
  std::map<std::string, std::pair<std::string, std::size_t>> found_;
};

}  // namespace

std::vector<std::string> unusedFields(const GltfJson& json) {
  Walk walk;
  if (const auto used = json.find("extensionsUsed"); used != json.end())
    for (const GltfJson& name : *used) walk.used(name);
  walk.object(json, "", {});
  return walk.sentences();
}

void checkRequiredExtensions(const std::string& file, const GltfJson& json) {
  const auto required = json.find("extensionsRequired");
  if (required == json.end() || !required->is_array()) return;
  for (const GltfJson& name : *required) {
    if (!name.is_string()) continue;
    const GltfExtension* known = extensionNamed(name);
    if (known && known->use != kRefused) continue;
    throw InputError(file, "extensionsRequired",
                     "\"" + name.get<std::string>() + "\" is not supported; " +
                         (known ? known->sentence : "export the model without it"));
  }
}

std::string gltfTable() {
  std::map<FieldUse, std::string> words = {{kNoEffect, "no effect"},
                                           {kNear, "approximated"},
                                           {kLeftOut, "left out"},
                                           {kRefused, "refused if required"}};
  std::string table = "| field or extension | use | what it means |\n|-|-|-|\n";
  const auto add = [&](const char* name, FieldUse use, const char* sentence) {
    if (use != kUsed) table += std::string("| `") + name + "` | " + words.at(use) + " | " + sentence + " |\n";
  };
  for (const GltfField& field : gltfFields()) add(field.path, field.use, field.sentence);
  for (const GltfExtension& extension : gltfExtensions())
    add(extension.name, extension.use, extension.sentence);
  return table;
}

}  // namespace pellucid::harness
