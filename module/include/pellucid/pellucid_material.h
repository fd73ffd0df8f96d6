/* Materials: the constants that shaders evaluate, and a compiler that makes these constants from scattering coefficients.
 *
 * C ABI. The target pellucid::material has the compiler. Its functions are pure, run on the CPU in double precision, have no global
 * state, and may be called from any thread. Lengths are in mm, coefficients in 1/mm. Arrays of 3 are R, G, B.
 *
 * Symbols and lengths:
 * - sigma_s: scattering; sigma_a: absorption; g: mean cosine of scattering;
 * - sigma_s' = (1 - g) sigma_s: reduced scattering;
 * - T(d): transmittance of a slab of thickness d; rho: diffuse reflectance of a half-space;
 * - mean free path: 1 / (sigma_s + sigma_a), the length that OpenPBR takes;
 * - transport mean free path: 1 / (sigma_s' + sigma_a);
 * - diffusion length: 1 / kappa, the depth over which T(d) of thick slabs falls by the factor e.
 *
 * Physics: radiative transport in slabs and half-spaces with smooth Fresnel boundaries. Scattering is isotropic with sigma_s', by
 * similarity. The solution is by discrete ordinates (Chandrasekhar 1960; Stamnes et al. 1988).
 */
#ifndef PELLUCID_MATERIAL_H
#define PELLUCID_MATERIAL_H

#include "pellucid_base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- What shaders evaluate ----------------------------------------------------------------- */

/* Most Gaussians of a diffusion profile; words of a material's tables. */
enum { PELLUCID_MAX_GAUSSIANS = 8, PELLUCID_MATERIAL_TABLE_WORDS = 3712 };

/* Formula of T(d), the part of the flux into one face of a slab of thickness d (mm) that leaves by the other face.
 * PellucidMaterial::transmittance[channel] has the parameters, in the order of the comment. */
typedef enum PellucidTransmittanceModel {
  /* a1, k1, a2, k2: a1 e^{-k1 d} + a2 e^{-k2 d}, which falls with d from T(0) <= 1 on. */
  PELLUCID_TRANSMITTANCE_EXP2 = 0,
  /* a, kappa, z, b, c: a / sinh(kappa d + z) + b e^{-c d} with kappa >= 0, z > 0, c >= kappa unless b is 0, and T(0) <= 1. */
  PELLUCID_TRANSMITTANCE_SINH_EXP = 1,
  /* No parameters: the sum of w_i e^{-d^2 / (2 v_i)} over the Gaussians of weight w_i and variance v_i. The sum is the integral of
   * R(sqrt(r^2 + d^2)) over a plane, with the diffusion profile R (d'Eon & Luebke 2007). */
  PELLUCID_TRANSMITTANCE_GAUSSIANS = 2,
  /* No parameters: the sum of w_i e^{-d^2 / v_i}, with twice the exponent of GAUSSIANS, as Whelan 2009 eq. 2.11 prints it. */
  PELLUCID_TRANSMITTANCE_GAUSSIANS_AS_PRINTED = 3,
  /* dmax (mm, > 0): 1 - d / dmax, and 0 beyond dmax (Whelan 2009, 4.1). */
  PELLUCID_TRANSMITTANCE_LINEAR = 4
} PellucidTransmittanceModel;

/* The constants of a material: plain data, which a file may keep. pellucidCompileMaterial makes them from a description. Or the caller
 * fills the fields and calls pellucidMakeMaterialTables of pellucid.h. Lengths are at most 1e9 mm. */
typedef struct PellucidMaterial {
  /* PellucidTransmittanceModel. */
  uint32_t transmittanceModel;
  /* Parameters of the model: rates in 1/mm, lengths in mm, amplitudes without unit. */
  float transmittance[3][5];
  /* rho, (0, 1]: the part of diffuse light that a half-space returns. */
  float reflectance[3];
  /* Gaussians of the diffusion profile, 0..PELLUCID_MAX_GAUSSIANS; 0: the material does not diffuse. */
  uint32_t gaussianCount;
  /* Variance v along one axis, mm^2, > 0. The profile is the sum of w / (2 pi v) e^{-r^2 / (2 v)}. */
  float gaussianVariance[3][PELLUCID_MAX_GAUSSIANS];
  /* Weight w, 0..1. The weights of a channel sum to 1, within .001. */
  float gaussianWeight[3][PELLUCID_MAX_GAUSSIANS];
  /* mm, > 0: the distance from the entry of light within which 99.9 % of the diffused light leaves. */
  float radius[3];
  /* mm, >= 0: d of Christensen & Burley 2015 eq. 3. The diffusion takes this profile in place of the Gaussians, which fit it. 0 (default):
   * the Gaussians. */
  float burleyDistance[3];
  /* 1: a thin wall, as a leaf or paper. Light of one face times wallTransmittance leaves by the other face. `transmittance` is not read.
   * Shadow maps only say whether another surface blocks the light, and no light is gathered. 0 (default): a solid. */
  uint32_t thinWalled;
  /* The part of the other face's irradiance that comes through a thin wall, 0..1; default 0. wallTransmittance + reflectance <= 1. */
  float wallTransmittance[3];
  /* Private; pellucidCompileMaterial and pellucidMakeMaterialTables write it. Frames refuse tables of other fields or of another
   * PELLUCID_HEADER_VERSION. */
  uint32_t tables[PELLUCID_MATERIAL_TABLE_WORDS];
} PellucidMaterial;

/* ---- Compiler ---------------------------------------------------------------------------------- */

/* Kind of a description. Each kind reads the fields of PellucidMaterialDesc in its comment. All kinds also read gaussianCount: GAUSSIANS
 * has that number of Gaussians, and the other kinds fit that number. */
typedef enum PellucidMaterialKind {
  PELLUCID_MATERIAL_COEFFICIENTS = 0, /* scattering, absorption, g, ior, millimetersPerUnit */
  PELLUCID_MATERIAL_PRESET = 1,       /* preset, ior */
  PELLUCID_MATERIAL_BURLEY = 2,       /* burleyDistance, transmittance */
  PELLUCID_MATERIAL_GAUSSIANS = 3,    /* gaussianCount, gaussianVariance, gaussianWeight */
  PELLUCID_MATERIAL_SPECTRAL = 4,     /* wavelengths, spectral coefficients, illuminant, g, ior, millimetersPerUnit */
  PELLUCID_MATERIAL_SKIN = 5,         /* melanin, melaninType, hemoglobin, illuminant, ior */
  PELLUCID_MATERIAL_THIN_WALL = 6     /* wallReflectance, wallTransmittance, burleyDistance */
} PellucidMaterialKind;

/* The light under which T(d) and rho of each wavelength become linear Rec. 709, with the CIE 1931 2-degree observer. T = 1 at
 * every wavelength is (1, 1, 1) under each illuminant, because the engine's light colors carry the illuminant. Values outside
 * Rec. 709 are cut to 0..1. */
typedef enum PellucidIlluminant {
  PELLUCID_ILLUMINANT_D65 = 0, /* CIE standard illuminant D65 */
  PELLUCID_ILLUMINANT_A = 1,   /* CIE standard illuminant A, 2856 K */
  PELLUCID_ILLUMINANT_E = 2    /* equal energy */
} PellucidIlluminant;

/* Most samples of a spectrum. */
enum { PELLUCID_MAX_WAVELENGTHS = 1024 };

/* Description of a material. pellucidInitMaterialDesc writes the defaults, which are 0 where a comment has none. */
typedef struct PellucidMaterialDesc {
  /* PellucidMaterialKind. */
  uint32_t kind;
  /* 1..PELLUCID_MAX_GAUSSIANS; default 6, which has an edgeError of 4.5e-4. */
  uint32_t gaussianCount;
  /* PellucidIlluminant; default D65. */
  uint32_t illuminant;
  /* Zero-terminated name of a preset, as pellucidPresetName has it. */
  const char* preset;

  /* ---- Media ---- */

  /* sigma_s, >= 0. Give sigma_s' with g = 0 if only sigma_s' is known. */
  double scattering[3];
  /* sigma_a, >= 0. A channel needs sigma_s + sigma_a > 0. */
  double absorption[3];
  /* Mean cosine of scattering, -1 < g < 1. */
  double g;
  /* Index of refraction, relative to the outside, 1..3. 0 (default): the preset's index, or 1.4. */
  double ior;
  /* Millimeters of the unit u of coefficients in 1/u: 10 for 1/cm. 0 (default): 1, for 1/mm. */
  double millimetersPerUnit;

  /* ---- Diffusion profiles ---- */

  /* mm, > 0: d of Christensen & Burley 2015 eq. 3. THIN_WALL: the distance within the sheet; all 0 (default): light does not spread. */
  double burleyDistance[3];
  /* a1, k1, a2, k2 of T(d) = a1 e^{-k1 d} + a2 e^{-k2 d}, which falls and stays within 0..1; k in 1/mm. All 0 (default): Burley's slab
   * 1/4 e^{-d/b} + 3/4 e^{-d/(3 b)} with b = burleyDistance. */
  double transmittance[3][4];

  /* Variance along one axis, mm^2, > 0. */
  double gaussianVariance[PELLUCID_MAX_GAUSSIANS];
  /* >= 0. The compiler divides the weights of a channel by their sum. */
  double gaussianWeight[3][PELLUCID_MAX_GAUSSIANS];

  /* ---- Spectra: linear between samples, constant beyond the ends ---- */

  /* Samples of the three arrays, 2..PELLUCID_MAX_WAVELENGTHS. */
  uint32_t wavelengthCount;
  /* nm, strictly increasing. The range must meet 380..780. */
  const double* wavelength;
  /* sigma_s, >= 0. */
  const double* spectralScattering;
  /* sigma_a, >= 0. */
  const double* spectralAbsorption;

  /* ---- Skin by physiology, Donner & Jensen 2006 ---- */

  /* C_m, the melanin's part of the epidermis's volume, 0..1; fair .002, dark .3; default .005. */
  double melanin;
  /* beta_m, the part of the melanin that is eumelanin, 0..1; default .5. */
  double melaninType;
  /* C_h, the blood's part of the dermis's volume, 0..1; pale .001, flushed .1; default .005. */
  double hemoglobin;

  /* ---- Thin walls: reflectance + transmittance <= 1 ---- */

  /* The part of a face's irradiance that leaves by the same face, 0..1. The albedo image replaces this part. */
  double wallReflectance[3];
  /* The part of a face's irradiance that leaves by the other face, 0..1. */
  double wallTransmittance[3];
} PellucidMaterialDesc;

/* A channel of a compiled material: its input and the errors of the fit. */
typedef struct PellucidChannelReport {
  /* sigma_s' and sigma_a, 1/mm; 0 for kinds without RGB coefficients. */
  double scattering, absorption;
  /* Diffuse reflectance of a half-space under Lambertian light from outside, 0..1. Light that is reflected without entering does not
   * count. BURLEY and GAUSSIANS: 1, because the engine has the albedo. THIN_WALL: wallReflectance. PellucidMaterial::reflectance is the
   * larger of rho and 1e-4. */
  double rho;
  /* Largest |T_fit / T - 1| between minThickness and maxThickness, with float coefficients. For SPECTRAL and SKIN the divisor T is at least
   * half of the brightest channel's T. */
  double transmittanceError;
  /* mm: the fitted thicknesses, .01 to 20 where T > 1e-4. Very dense and very thin media have a wider range. */
  double minThickness, maxThickness;
  /* Largest difference of a blurred half-plane step between the Gaussians and Burley's profile, in parts of the step. */
  double edgeError;
} PellucidChannelReport;

/* Report of a compiled material. */
typedef struct PellucidMaterialReport {
  /* Zero-terminated name of the preset or the kind. */
  char name[64];
  /* The index of refraction that the compiler took; 0 for kinds without ior. */
  double ior;
  /* R, G, B. */
  PellucidChannelReport channels[3];
} PellucidMaterialReport;

/* Writes the defaults. */
PELLUCID_API void pellucidInitMaterialDesc(PellucidMaterialDesc* desc);

/* Compiles a material: fills every field of *material and of *report. `report` may be NULL. On failure the function writes neither,
 * and `message` (optional) names field and value. The call takes about 15 ms for RGB coefficients, 50 ms for spectra, and 200 ms for skin
 * by physiology. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. */
PELLUCID_API PellucidResult pellucidCompileMaterial(const PellucidMaterialDesc* desc, PellucidMaterial* material,
                                                    PellucidMaterialReport* report, PellucidMessageFn message,
                                                    void* messageUser);

/* ---- Exact transport ------------------------------------------------------------------------- */

/* Light that a slab transmits and reflects. */
typedef struct PellucidSlab {
  /* Flux out of the far face, divided by the Lambertian flux that arrives at the near face, 0..1. */
  double transmittance;
  /* Flux out of the far face, divided by the flux of a beam of normal incidence, 0..1. */
  double transmittanceNormal;
  /* Flux that enters and leaves by the near face, divided by the Lambertian flux that arrives there, 0..1. */
  double reflectance;
} PellucidSlab;

/* Light of one slab. scattering: sigma_s', 1/mm. absorption: sigma_a, 1/mm. ior: 1..3. thickness: mm, >= 0; INFINITY is the
 * half-space. `message` is optional. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. */
PELLUCID_API PellucidResult pellucidSlabTransport(double scattering, double absorption, double ior, double thickness,
                                                  PellucidSlab* slab, PellucidMessageFn message, void* messageUser);

/* Light of `count` slabs, to which the compiler fits a material's T(d): slabs[3 * i + channel] for thickness[i] in mm, >= 0. BURLEY
 * and GAUSSIANS have their own T(d) for both incidences, and reflectance 0. THIN_WALL has wallTransmittance and wallReflectance at
 * every thickness. `message` is optional. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. */
PELLUCID_API PellucidResult pellucidMaterialSlabs(const PellucidMaterialDesc* desc, uint32_t count,
                                                  const double* thickness, PellucidSlab* slabs, PellucidMessageFn message,
                                                  void* messageUser);

/* T(d) as the shaders evaluate it. channel: 0..2. thickness: mm, >= 0. Returns NaN for an invalid channel or model. */
PELLUCID_API double pellucidEvaluateTransmittance(const PellucidMaterial* material, uint32_t channel, double thickness);

/* ---- Presets --------------------------------------------------------------------------------- */

/* Number of presets. A preset has an index below this number. */
PELLUCID_API uint32_t pellucidPresetCount(void);

/* Name of a preset in lower case, as "skin1" or "whole_milk": a static string. NULL: no preset has the index. */
PELLUCID_API const char* pellucidPresetName(uint32_t index);

/* Describes a preset. Presets of RGB coefficients become kind COEFFICIENTS with the preset's index of refraction. Layered skin becomes
 * kind PRESET. Other fields get their defaults. Upper and lower case are equal in a name, and so are ' ', '-' and '_'. Errors:
 * INVALID_ARGUMENT if no preset has the name. */
PELLUCID_API PellucidResult pellucidFindPreset(const char* name, PellucidMaterialDesc* desc);

/* ---- OpenPBR --------------------------------------------------------------------------------- */

/* The subsurface medium of OpenPBR Surface 1.1 and MaterialX's open_pbr_surface. Names, meanings and defaults are those of OpenPBR.
 * Colors are linear. */
typedef struct PellucidOpenPbr {
  /* The part of the light entering along the normal that comes back out, 0..1; default .8. */
  double subsurfaceColor[3];
  /* > 0; default 1, in the unit of millimetersPerUnit. Radius times scale is the mean free path 1 / (sigma_s + sigma_a). */
  double subsurfaceRadius;
  /* Factor of the radius for R, G, B, > 0; default 1, .5, .25. */
  double subsurfaceRadiusScale[3];
  /* Mean cosine g of scattering, -1 < g < 1; default 0. */
  double subsurfaceScatterAnisotropy;
  /* Index of refraction, 1..3; default 1.5. */
  double specularIor;
  /* Millimeters of the unit of subsurfaceRadius, > 0; default 1. */
  double millimetersPerUnit;
} PellucidOpenPbr;

/* Writes the defaults of OpenPBR. */
PELLUCID_API void pellucidInitOpenPbr(PellucidOpenPbr* material);

/* Describes an OpenPBR medium as kind COEFFICIENTS, in 1/mm. The extinction sigma_s + sigma_a is 1 / (radius scale). The
 * single-scattering albedo gives subsurfaceColor behind the smooth boundary of specularIor. The albedo follows from OpenPBR's definition of
 * the color and the transport of this header, to 1e-4 of the color for g = 0. Other g follow by similarity. Other fields of *desc get their
 * defaults. On failure *desc does not change, and `message` (optional) names field and value. The function takes about 20 ms. Errors:
 * INVALID_ARGUMENT, OUT_OF_MEMORY. */
PELLUCID_API PellucidResult pellucidDescribeOpenPbr(const PellucidOpenPbr* material, PellucidMaterialDesc* desc,
                                                    PellucidMessageFn message, void* messageUser);

#ifdef __cplusplus
}
#endif
#endif
