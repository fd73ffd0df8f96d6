/* Materials: the constants that shaders evaluate, and the compiler that makes them from physical scattering coefficients.
 *
 * C ABI. The compiler is of target pellucid::material. Pure functions on the CPU, double inside, no global state: same
 * input, same output, callable from any thread. Lengths in mm, coefficients in 1/mm.
 *
 * Physics: radiative transport with isotropic scattering by similarity, sigma_s' = (1 - g) sigma_s,
 * in slabs and half-spaces with smooth Fresnel boundaries, solved by discrete ordinates (Chandrasekhar
 * 1960; Stamnes et al. 1988). Index order of arrays of 3: R, G, B.
 */
#ifndef PELLUCID_MATERIAL_H
#define PELLUCID_MATERIAL_H

#include "pellucid_base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- What shaders evaluate ----------------------------------------------------------------- */

enum { PELLUCID_MAX_GAUSSIANS = 8 };

/* T(d): fraction of the flux entering one face of a slab of thickness d (mm) that leaves the other.
 * The parameters are PellucidMaterial::transmittance[channel], in the order given here. */
typedef enum PellucidTransmittanceModel {
  /* a1, k1, a2, k2: a1 e^{-k1 d} + a2 e^{-k2 d}. */
  PELLUCID_TRANSMITTANCE_EXP2 = 0,
  /* a, kappa, z, b, c: a / sinh(kappa d + z) + b e^{-c d}. */
  PELLUCID_TRANSMITTANCE_SINH_EXP = 1,
  /* None: sum w_i e^{-d^2 / (2 v_i)} over the profile's own Gaussians (d'Eon 2007; R(sqrt(r^2+d^2)) integrated). */
  PELLUCID_TRANSMITTANCE_GAUSSIANS = 2,
  /* None: e^{-d^2 / v_i}, as Whelan 2009 eq. 2.11 prints it; twice the exponent that the integral gives. */
  PELLUCID_TRANSMITTANCE_GAUSSIANS_AS_PRINTED = 3,
  /* dmax (mm, > 0): 1 - d/dmax, 0 beyond (Whelan 2009, 4.1). */
  PELLUCID_TRANSMITTANCE_LINEAR = 4
} PellucidTransmittanceModel;

/* Constants that the shaders evaluate. pellucidCompileMaterial fills them from physical coefficients or a preset, or you do. */
typedef struct PellucidMaterial {
  /* sizeof(PellucidMaterial); one size for all of a frame. */
  uint32_t structSize;
  /* PellucidTransmittanceModel. */
  uint32_t transmittanceModel;
  /* 1/mm for rates, 1 for amplitudes; see the model. */
  float transmittance[3][5];
  /* rho, semi-infinite diffuse reflectance, (0, 1]. */
  float reflectance[3];
  /* 1..PELLUCID_MAX_GAUSSIANS; 0: the material does not diffuse. */
  uint32_t gaussianCount;
  /* mm^2, > 0, of one axis: w/(2 pi v) e^{-r^2/2v}. */
  float gaussianVariance[3][PELLUCID_MAX_GAUSSIANS];
  /* Each channel sums to 1. */
  float gaussianWeight[3][PELLUCID_MAX_GAUSSIANS];
  /* mm, within which 99.9 % of the diffused energy lies. */
  float radius[3];
  /* ---- fields that may be missing ---- */
  /* mm; d of Christensen & Burley 2015 eq. 3 that the Gaussians fit. The diffusion takes it in their place; 0 (default): the Gaussians. */
  float burleyDistance[3];
  /* 1: a sheet without thickness, like leaves and paper. Light that arrives at one face leaves by the other times wallTransmittance, and
   * `transmittance` is not read. Shadow maps only say whether something else blocks the light. Not gathered. 0 (default): a solid. */
  uint32_t thinWalled;
  /* Of the irradiance of the other face, [0, 1]; with `reflectance` at most 1. */
  float wallTransmittance[3];
} PellucidMaterial;

/* ---- Compiler ---------------------------------------------------------------------------------- */

/* How a material is described; each kind reads the fields of PellucidMaterialDesc listed with it,
 * besides `gaussianCount` (all but GAUSSIANS fit that many). */
typedef enum PellucidMaterialKind {
  PELLUCID_MATERIAL_COEFFICIENTS = 0, /* scattering, absorption, g, ior, millimetersPerUnit */
  PELLUCID_MATERIAL_PRESET = 1,       /* preset, ior; see pellucidPresetName */
  PELLUCID_MATERIAL_BURLEY = 2,       /* burleyDistance, transmittance */
  PELLUCID_MATERIAL_GAUSSIANS = 3,    /* gaussianCount, gaussianVariance, gaussianWeight */
  PELLUCID_MATERIAL_SPECTRAL = 4,     /* the spectrum, illuminant, g, ior, millimetersPerUnit */
  PELLUCID_MATERIAL_SKIN = 5,         /* melanin, melaninType, hemoglobin, illuminant, ior */
  PELLUCID_MATERIAL_THIN_WALL = 6     /* wallReflectance, wallTransmittance, burleyDistance */
} PellucidMaterialKind;

/* The light under which values per wavelength (T(d), rho) become linear Rec. 709, with the CIE 1931
 * 2-degree observer. T = 1 at every wavelength is (1, 1, 1) under any of them: the engine's light
 * colors carry the illuminant. Values outside Rec. 709 are cut to [0, 1]. */
typedef enum PellucidIlluminant {
  PELLUCID_ILLUMINANT_D65 = 0, /* CIE standard illuminant D65 */
  PELLUCID_ILLUMINANT_A = 1,   /* CIE standard illuminant A, 2856 K */
  PELLUCID_ILLUMINANT_E = 2    /* equal energy */
} PellucidIlluminant;

enum { PELLUCID_MAX_WAVELENGTHS = 1024 };

/* A material as people describe it. */
typedef struct PellucidMaterialDesc {
  uint32_t structSize;    /* sizeof(PellucidMaterialDesc), written by pellucidInitMaterialDesc */
  uint32_t kind;          /* PellucidMaterialKind */
  uint32_t gaussianCount; /* 1..PELLUCID_MAX_GAUSSIANS; default 6 (edge error 5e-4) */
  uint32_t illuminant;    /* PellucidIlluminant */
  const char* preset;     /* zero-terminated name */

  double scattering[3];      /* sigma_s, >= 0; the reduced sigma_s' when g = 0 */
  double absorption[3];      /* sigma_a, >= 0; a channel where both are 0 is refused */
  double g;                  /* mean cosine of scattering, (-1, 1) */
  double ior;                /* relative index of refraction, [1, 3]; 0: the preset's own, else 1.4 */
  double millimetersPerUnit; /* of the unit the coefficients are inverse to; 0: 1 (1/mm); 10: 1/cm */

  double burleyDistance[3]; /* mm, > 0; d of Christensen & Burley 2015 eq. 3. THIN_WALL: within the sheet; all
                               0 (default): light does not spread sideways */
  double transmittance[3][4]; /* a1, k1, a2, k2 of T(d) = a1 e^{-k1 d} + a2 e^{-k2 d}, decreasing and
                                 within [0, 1]; all 0: Burley's slab 1/4 e^{-d/l} + 3/4 e^{-d/3l} */

  double gaussianVariance[PELLUCID_MAX_GAUSSIANS];  /* mm^2, > 0, of one axis */
  double gaussianWeight[3][PELLUCID_MAX_GAUSSIANS]; /* >= 0; normalized to sum 1 per channel */

  /* Coefficients sampled over the visible range; linear in between, constant beyond the ends. */
  uint32_t wavelengthCount;         /* 2..PELLUCID_MAX_WAVELENGTHS */
  const double* wavelength;         /* nm, strictly increasing, the range must meet 380..780 */
  const double* spectralScattering; /* sigma_s, >= 0 */
  const double* spectralAbsorption; /* sigma_a, >= 0 */

  /* Skin by physiology, Donner & Jensen 2006 */
  double melanin;     /* C_m, volume fraction in the epidermis, [0, 1]; fair .002, dark .3; default .005 */
  double melaninType; /* beta_m, share of eumelanin, [0, 1]; default .5 */
  double hemoglobin;  /* C_h, volume fraction of blood in the dermis, [0, 1]; pale .001, flushed .1;
                         default .005 */

  /* A sheet without thickness: parts of the irradiance of a face, [0, 1], together at most 1 */
  double wallReflectance[3];   /* that leave by the same face; what the albedo stands for */
  double wallTransmittance[3]; /* that leave by the other face */
} PellucidMaterialDesc;

/* A channel's input, and how well the result fits. */
typedef struct PellucidChannelReport {
  double scattering, absorption;     /* sigma_s', sigma_a, 1/mm; 0 for kinds without RGB coefficients */
  double rho;                        /* diffuse reflectance of the half-space under Lambertian light from
                                        outside; the light reflected without entering is not counted.
                                        1 for kinds BURLEY and GAUSSIANS, whose albedo is the engine's;
                                        of THIN_WALL wallReflectance.
                                        PellucidMaterial::reflectance is this, at least 1e-4 */
  double transmittanceError;         /* largest |T_fit / T - 1| on the thicknesses fitted, of the float
                                        coefficients. T in the denominator is at least half of the
                                        brightest channel's where wavelengths mix */
  double minThickness, maxThickness; /* mm; fitted: 0.01 to 20 as far as T > 1e-4, more for dense and
                                        thin media */
  double edgeError;                  /* largest difference of the blurred half-plane step, Gaussians
                                        against Burley */
} PellucidChannelReport;

/* Input of a compiled material. */
typedef struct PellucidMaterialReport {
  char name[64]; /* the preset's name, or the kind */
  double ior;    /* the one used; 0 for kinds without */
  PellucidChannelReport channels[3]; /* R, G, B */
} PellucidMaterialReport;

PELLUCID_API void pellucidInitMaterialDesc(PellucidMaterialDesc* desc); /* the defaults */

/* Fills every field of *material, and *report when not NULL. On failure neither is written and
 * `message` (optional) names the field and its value. About 15 ms for RGB coefficients, 50 for
 * spectra, 200 for skin by physiology.
 * Errors: INVALID_ARGUMENT, VERSION, OUT_OF_MEMORY. */
PELLUCID_API PellucidResult pellucidCompileMaterial(const PellucidMaterialDesc* desc, PellucidMaterial* material,
                                                    PellucidMaterialReport* report, PellucidMessageFn message,
                                                    void* messageUser);

/* ---- Exact transport ------------------------------------------------------------------------- */

/* Light that a slab transmits and reflects. */
typedef struct PellucidSlab {
  double transmittance;       /* flux out of the far face / Lambertian flux arriving on the near face */
  double transmittanceNormal; /* the same for a beam at normal incidence */
  double reflectance;         /* Lambertian light that enters and comes back out of the near face */
} PellucidSlab;

/* One slab of thickness d >= 0 mm; d = INFINITY is the half-space. scattering is sigma_s'.
 * Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. */
PELLUCID_API PellucidResult pellucidSlabTransport(double scattering, double absorption, double ior, double thickness,
                                                  PellucidSlab* slab, PellucidMessageFn message, void* messageUser);

/* Slabs that a material's T(d) was fitted to: slabs[3 * i + channel] for thickness[i], >= 0 mm. Of BURLEY
 * and GAUSSIANS it is the function they define, for both incidences, and reflectance is 0. A THIN_WALL has
 * wallTransmittance and wallReflectance at every thickness. */
PELLUCID_API PellucidResult pellucidMaterialSlabs(const PellucidMaterialDesc* desc, uint32_t count,
                                                  const double* thickness, PellucidSlab* slabs, PellucidMessageFn message,
                                                  void* messageUser);

/* T(d) as the shaders evaluate it, d >= 0 mm, channel 0..2; NaN for a bad channel or model. */
PELLUCID_API double pellucidEvaluateTransmittance(const PellucidMaterial* material, uint32_t channel, double thickness);

/* ---- Presets --------------------------------------------------------------------------------- */

PELLUCID_API uint32_t pellucidPresetCount(void); /* presets have the indices below it */

/* Lower case, e.g. "skin1", "whole_milk"; static string, or NULL beyond the last. */
PELLUCID_API const char* pellucidPresetName(uint32_t index);

/* Describes a preset: RGB coefficients as kind COEFFICIENTS with its index of refraction, layered skin
 * as kind PRESET. Case and the difference between ' ', '-', '_' do not matter. Other fields get their
 * defaults. INVALID_ARGUMENT when there is no such preset. */
PELLUCID_API PellucidResult pellucidFindPreset(const char* name, PellucidMaterialDesc* desc);

/* ---- OpenPBR --------------------------------------------------------------------------------- */

/* The subsurface medium of OpenPBR Surface 1.1 and MaterialX's open_pbr_surface, with the names, meanings
 * and defaults of that specification. Colors are linear. */
typedef struct PellucidOpenPbr {
  uint32_t structSize;                /* sizeof(PellucidOpenPbr), written by pellucidInitOpenPbr */
  double subsurfaceColor[3];          /* [0, 1]; default .8: share of the light that enters along the normal
                                         and comes back out, by all scattering */
  double subsurfaceRadius;            /* > 0; default 1; times the scale: mean free path */
  double subsurfaceRadiusScale[3];    /* > 0; default 1, .5, .25 */
  double subsurfaceScatterAnisotropy; /* g, (-1, 1); default 0 */
  double specularIor;                 /* [1, 3]; default 1.5 */
  double millimetersPerUnit;          /* of subsurfaceRadius; > 0; default 1 */
} PellucidOpenPbr;

PELLUCID_API void pellucidInitOpenPbr(PellucidOpenPbr* material); /* the specification's defaults */

/* Describes an OpenPBR medium as kind COEFFICIENTS, in 1/mm: extinction 1 / (radius scale), and the
 * single-scattering albedo that gives subsurfaceColor behind the smooth boundary of specularIor. The albedo
 * solves the specification's own definition with the transport of this header, to 1e-4 of the color for
 * g = 0, and by similarity for others. Other fields of *desc get their defaults. On failure *desc stays as
 * it is and `message` (optional) names the field and its value. About 20 ms.
 * Errors: INVALID_ARGUMENT, VERSION, OUT_OF_MEMORY. */
PELLUCID_API PellucidResult pellucidDescribeOpenPbr(const PellucidOpenPbr* material, PellucidMaterialDesc* desc,
                                                    PellucidMessageFn message, void* messageUser);

#ifdef __cplusplus
}
#endif
#endif
