// SPDX-License-Identifier: MIT
// Made by tools/elementary_tables.py; do not edit. Tables and coefficients of the elementary
// functions.
#pragma once
#include <cstdint>

namespace puppetri::elementary {

// ln 2: the high part is a multiple of 2^-42, so that k * high is exact for |k| < 2^11.
inline constexpr double kLn2High = 0x1.62e42fefa3800p-1;
inline constexpr double kLn2Low = 0x1.ef35793c76730p-45;
inline constexpr double kLog2OfE = 0x1.71547652b82fep+0;

// ln(j / 128) for j = 90 .. 182, high (a multiple of 2^-42) + low.
inline constexpr double kLog[93][2] = {
    {-0x1.68ac83e9c7000p-2, 0x1.7af966c548a30p-44},
    {-0x1.5d5bddf596000p-2, 0x1.a0b2a08a465dcp-47},
    {-0x1.522ae0738a000p-2, -0x1.ebe708164c759p-45},
    {-0x1.4718dc271c000p-2, -0x1.06c18fb4c14c5p-44},
    {-0x1.3c25277333000p-2, -0x1.83b54b606bd5cp-46},
    {-0x1.314f1e1d36000p-2, 0x1.8e27ad3213cb8p-45},
    {-0x1.269621134e000p-2, 0x1.1b61f10522625p-44},
    {-0x1.1bf99635a7000p-2, 0x1.1ac89575c2125p-44},
    {-0x1.1178e8227e000p-2, -0x1.1ef78ce2d07f2p-44},
    {-0x1.07138604d6000p-2, 0x1.e76324e912b17p-44},
    {-0x1.f991c6cb3c000p-3, 0x1.90d04cd7cc834p-44},
    {-0x1.e530effe72000p-3, 0x1.fdbdbb13f7c18p-44},
    {-0x1.d1037f2656000p-3, 0x1.84a7e75b6f6e4p-47},
    {-0x1.bd087383be000p-3, 0x1.d4bc4595412b6p-45},
    {-0x1.a93ed3c8ae000p-3, 0x1.8724350562169p-45},
    {-0x1.95a5adcf70000p-3, -0x1.7f22858a0ff6fp-47},
    {-0x1.823c16551a000p-3, -0x1.e0ddb9a631e83p-46},
    {-0x1.6f0128b756000p-3, -0x1.577390d31ef0fp-44},
    {-0x1.5bf406b544000p-3, 0x1.27023eb68981cp-46},
    {-0x1.4913d8333c000p-3, 0x1.53e43558124c4p-44},
    {-0x1.365fcb015a000p-3, 0x1.fd3a0afb9691bp-44},
    {-0x1.23d712a49c000p-3, -0x1.00d238fd3df5cp-46},
    {-0x1.1178e8227e000p-3, -0x1.1ef78ce2d07f2p-45},
    {-0x1.fe89139dbc000p-4, -0x1.56594d82f7a82p-44},
    {-0x1.da72763844000p-4, -0x1.a89401fa71733p-46},
    {-0x1.b6ac88dad4000p-4, -0x1.b1bdff50225c7p-44},
    {-0x1.9335e5d594000p-4, -0x1.3115c3abd47dap-45},
    {-0x1.700d30aeac000p-4, -0x1.c1e8da99ded32p-49},
    {-0x1.4d3115d208000p-4, 0x1.53a2582f4e1efp-48},
    {-0x1.2aa04a4470000p-4, -0x1.7a48ba8b1cb41p-44},
    {-0x1.08598b59e4000p-4, 0x1.7e5dd7009902cp-46},
    {-0x1.ccb73cddd8000p-5, -0x1.965c36e09f5fep-44},
    {-0x1.894aa149f8000p-5, -0x1.9a19a8be97661p-44},
    {-0x1.466aed42e0000p-5, 0x1.c167375bdfd28p-45},
    {-0x1.0415d89e78000p-5, 0x1.dddc7f461c516p-44},
    {-0x1.8492528c90000p-6, 0x1.aa0ba325a0c34p-45},
    {-0x1.0205658930000p-6, -0x1.611d27c8e8417p-44},
    {-0x1.0101575880000p-7, -0x1.bce251998b506p-44},
    {0x0.0p+0, 0x0.0p+0},
    {0x1.fe02a6b100000p-8, 0x1.9e23f0dda40e4p-46},
    {0x1.fc0a8b0fc0000p-7, 0x1.f1e7cf6d3a69cp-50},
    {0x1.7b91b07d60000p-6, -0x1.3b955b602ace4p-44},
    {0x1.f829b0e780000p-6, 0x1.980267c7e09e4p-45},
    {0x1.39e87b9fe8000p-5, 0x1.eafd480ad9015p-44},
    {0x1.77458f6330000p-5, -0x1.181dce586af09p-44},
    {0x1.b42dd71198000p-5, -0x1.c827ae5d6704cp-46},
    {0x1.f0a30c0118000p-5, -0x1.d599e83368e91p-45},
    {0x1.16536eea38000p-4, -0x1.47c5e768fa309p-46},
    {0x1.341d7961bc000p-4, 0x1.1d09299837610p-44},
    {0x1.51b073f060000p-4, 0x1.83f69278e686ap-44},
    {0x1.6f0d28ae58000p-4, -0x1.4b4641b664613p-44},
    {0x1.8c345d6318000p-4, 0x1.b20f5acb42a66p-44},
    {0x1.a926d3a4ac000p-4, 0x1.563650bd22a9cp-44},
    {0x1.c5e548f5bc000p-4, 0x1.d0c57585fbe06p-46},
    {0x1.e27076e2b0000p-4, -0x1.a342c2af0003cp-45},
    {0x1.fec9131dc0000p-4, -0x1.54555d1ae6607p-44},
    {0x1.0d77e7cd08000p-3, 0x1.cb2cd2ee2f482p-44},
    {0x1.1b72ad52f6000p-3, 0x1.e80a41811a396p-45},
    {0x1.29552f8200000p-3, -0x1.5b967f4471dfcp-44},
    {0x1.371fc201e8000p-3, 0x1.ee8779b2d8abcp-44},
    {0x1.44d2b6ccb8000p-3, -0x1.70cc16135783cp-46},
    {0x1.526e5e3a1c000p-3, -0x1.790ba37fc5238p-44},
    {0x1.5ff3070a7a000p-3, -0x1.8586f183bebf2p-44},
    {0x1.6d60fe719e000p-3, -0x1.bc6e557134767p-44},
    {0x1.7ab890210e000p-3, -0x1.bdb9072534a58p-45},
    {0x1.87fa06520c000p-3, 0x1.22120401202fcp-44},
    {0x1.9525a9cf46000p-3, -0x1.297137d9f158fp-44},
    {0x1.a23bc1fe2c000p-3, -0x1.539cd91dc9f0bp-44},
    {0x1.af3c94e80c000p-3, -0x1.a4e633fcd9066p-52},
    {0x1.bc286742d8000p-3, 0x1.9ac53f39d121cp-44},
    {0x1.c8ff7c79aa000p-3, -0x1.7794f689f8434p-45},
    {0x1.d5c216b4fc000p-3, -0x1.1ba91bbca681bp-45},
    {0x1.e27076e2b0000p-3, -0x1.a342c2af0003cp-44},
    {0x1.ef0adcbdc6000p-3, -0x1.b26b79c86af24p-45},
    {0x1.fb9186d5e4000p-3, -0x1.d572aab993c87p-47},
    {0x1.0402594b4d000p-2, 0x1.036b89ef42d7fp-48},
    {0x1.0a324e2739000p-2, 0x1.c6bee7ef4030ep-47},
    {0x1.1058bf9ae5000p-2, -0x1.4ab9d817d52cdp-44},
    {0x1.1675cababa000p-2, 0x1.8380e731f55c4p-44},
    {0x1.1c898c169a000p-2, -0x1.81410e5c62affp-44},
    {0x1.22941fbcf8000p-2, -0x1.a6976f5eb0963p-44},
    {0x1.2895a13de8000p-2, 0x1.a8d7ad24c13f0p-44},
    {0x1.2e8e2bae12000p-2, -0x1.67b1e99b72bd8p-45},
    {0x1.347dd9a988000p-2, -0x1.5594dd4c58092p-45},
    {0x1.3a64c55694000p-2, 0x1.7a71cbcd735d0p-44},
    {0x1.404308686a000p-2, 0x1.f8ef43049f7d3p-44},
    {0x1.4618bc21c6000p-2, -0x1.3d82f484c84ccp-46},
    {0x1.4be5f95778000p-2, -0x1.d7c92cd9ad824p-44},
    {0x1.51aad872e0000p-2, -0x1.f4bd8db0a7cc1p-44},
    {0x1.5767717456000p-2, -0x1.64ead9524d7cap-44},
    {0x1.5d1bdbf581000p-2, -0x1.8d6bdc9c7c238p-44},
    {0x1.62c82f2b9c000p-2, 0x1.e54bdbd7c8a98p-44},
    {0x1.686c81e9b1000p-2, 0x1.2bb110af84054p-44},
};

// 2^(j / 64) for j = 0 .. 63, high + low.
inline constexpr double kExp2[64][2] = {
    {0x1.0000000000000p+0, 0x0.0p+0},
    {0x1.02c9a3e778061p+0, -0x1.19083535b085dp-56},
    {0x1.059b0d3158574p+0, 0x1.d73e2a475b465p-55},
    {0x1.0874518759bc8p+0, 0x1.186be4bb284ffp-57},
    {0x1.0b5586cf9890fp+0, 0x1.8a62e4adc610bp-54},
    {0x1.0e3ec32d3d1a2p+0, 0x1.03a1727c57b53p-59},
    {0x1.11301d0125b51p+0, -0x1.6c51039449b3ap-54},
    {0x1.1429aaea92de0p+0, -0x1.32fbf9af1369ep-54},
    {0x1.172b83c7d517bp+0, -0x1.19041b9d78a76p-55},
    {0x1.1a35beb6fcb75p+0, 0x1.e5b4c7b4968e4p-55},
    {0x1.1d4873168b9aap+0, 0x1.e016e00a2643cp-54},
    {0x1.2063b88628cd6p+0, 0x1.dc775814a8495p-55},
    {0x1.2387a6e756238p+0, 0x1.9b07eb6c70573p-54},
    {0x1.26b4565e27cddp+0, 0x1.2bd339940e9d9p-55},
    {0x1.29e9df51fdee1p+0, 0x1.612e8afad1255p-55},
    {0x1.2d285a6e4030bp+0, 0x1.0024754db41d5p-54},
    {0x1.306fe0a31b715p+0, 0x1.6f46ad23182e4p-55},
    {0x1.33c08b26416ffp+0, 0x1.32721843659a6p-54},
    {0x1.371a7373aa9cbp+0, -0x1.63aeabf42eae2p-54},
    {0x1.3a7db34e59ff7p+0, -0x1.5e436d661f5e3p-56},
    {0x1.3dea64c123422p+0, 0x1.ada0911f09ebcp-55},
    {0x1.4160a21f72e2ap+0, -0x1.ef3691c309278p-58},
    {0x1.44e086061892dp+0, 0x1.89b7a04ef80d0p-59},
    {0x1.486a2b5c13cd0p+0, 0x1.3c1a3b69062f0p-56},
    {0x1.4bfdad5362a27p+0, 0x1.d4397afec42e2p-56},
    {0x1.4f9b2769d2ca7p+0, -0x1.4b309d25957e3p-54},
    {0x1.5342b569d4f82p+0, -0x1.07abe1db13cadp-55},
    {0x1.56f4736b527dap+0, 0x1.9bb2c011d93adp-54},
    {0x1.5ab07dd485429p+0, 0x1.6324c054647adp-54},
    {0x1.5e76f15ad2148p+0, 0x1.ba6f93080e65ep-54},
    {0x1.6247eb03a5585p+0, -0x1.383c17e40b497p-54},
    {0x1.6623882552225p+0, -0x1.bb60987591c34p-54},
    {0x1.6a09e667f3bcdp+0, -0x1.bdd3413b26456p-54},
    {0x1.6dfb23c651a2fp+0, -0x1.bbe3a683c88abp-57},
    {0x1.71f75e8ec5f74p+0, -0x1.16e4786887a99p-55},
    {0x1.75feb564267c9p+0, -0x1.0245957316dd3p-54},
    {0x1.7a11473eb0187p+0, -0x1.41577ee04992fp-55},
    {0x1.7e2f336cf4e62p+0, 0x1.05d02ba15797ep-56},
    {0x1.82589994cce13p+0, -0x1.d4c1dd41532d8p-54},
    {0x1.868d99b4492edp+0, -0x1.fc6f89bd4f6bap-54},
    {0x1.8ace5422aa0dbp+0, 0x1.6e9f156864b27p-54},
    {0x1.8f1ae99157736p+0, 0x1.5cc13a2e3976cp-55},
    {0x1.93737b0cdc5e5p+0, -0x1.75fc781b57ebcp-57},
    {0x1.97d829fde4e50p+0, -0x1.d185b7c1b85d1p-54},
    {0x1.9c49182a3f090p+0, 0x1.c7c46b071f2bep-56},
    {0x1.a0c667b5de565p+0, -0x1.359495d1cd533p-54},
    {0x1.a5503b23e255dp+0, -0x1.d2f6edb8d41e1p-54},
    {0x1.a9e6b5579fdbfp+0, 0x1.0fac90ef7fd31p-54},
    {0x1.ae89f995ad3adp+0, 0x1.7a1cd345dcc81p-54},
    {0x1.b33a2b84f15fbp+0, -0x1.2805e3084d708p-57},
    {0x1.b7f76f2fb5e47p+0, -0x1.5584f7e54ac3bp-56},
    {0x1.bcc1e904bc1d2p+0, 0x1.23dd07a2d9e84p-55},
    {0x1.c199bdd85529cp+0, 0x1.11065895048ddp-55},
    {0x1.c67f12e57d14bp+0, 0x1.2884dff483cadp-54},
    {0x1.cb720dcef9069p+0, 0x1.503cbd1e949dbp-56},
    {0x1.d072d4a07897cp+0, -0x1.cbc3743797a9cp-54},
    {0x1.d5818dcfba487p+0, 0x1.2ed02d75b3707p-55},
    {0x1.da9e603db3285p+0, 0x1.c2300696db532p-54},
    {0x1.dfc97337b9b5fp+0, -0x1.1a5cd4f184b5cp-54},
    {0x1.e502ee78b3ff6p+0, 0x1.39e8980a9cc8fp-55},
    {0x1.ea4afa2a490dap+0, -0x1.e9c23179c2893p-54},
    {0x1.efa1bee615a27p+0, 0x1.dc7f486a4b6b0p-54},
    {0x1.f50765b6e4540p+0, 0x1.9d3e12dd8a18bp-54},
    {0x1.fa7c1819e90d8p+0, 0x1.74853f3a5931ep-55},
};

// ln 2 / 64: the high part has 32 bits, so that k * high is exact for |k| < 2^21.
inline constexpr double kLn2By64High = 0x1.62e42ff000000p-7;
inline constexpr double kLn2By64Low = -0x1.718432a1b0e26p-41;
inline constexpr double k64ByLn2 = 0x1.71547652b82fep+6;

// atan(j / 16) for j = 0 .. 16, high + low.
inline constexpr double kAtan[17][2] = {
    {0x0.0p+0, 0x0.0p+0},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
};

// (sin(x) / x - 1) / x^2 in x^2, |x| <= pi/4. Largest relative error 2^-54.0.
inline constexpr double kSin[7] = {
    -0x1.5555555555555p-3,  0x1.1111111111110p-7,  -0x1.a01a01a019938p-13, 0x1.71de3a546095bp-19,
    -0x1.ae645412c560cp-26, 0x1.61217f0b800d5p-33, -0x1.ab17d404de5b3p-41,
};

// (cos(x) - 1 + x^2/2) / x^4 in x^2, |x| <= pi/4. Largest relative error 2^-54.0.
inline constexpr double kCos[6] = {
    0x1.5555555555555p-5,   -0x1.6c16c16c16967p-10, 0x1.a01a019f4eb01p-16,
    -0x1.27e4fa17da09ep-22, 0x1.1eeb68e93b64cp-29,  -0x1.907da367a37cbp-37,
};

// pi/2 in four pieces: 33, 33, 33 and 53 bits.
inline constexpr double kHalfPi[4] = {0x1.921fb54400000p+0, 0x1.0b4611a600000p-34,
                                      0x1.3198a2e000000p-69, 0x1.b839a252049c1p-104};
inline constexpr double kTwoByPi = 0x1.45f306dc9c883p-1;
inline constexpr double kHalfPiHigh = 0x1.921fb54442d18p+0;
inline constexpr double kHalfPiLow = 0x1.1a62633145c07p-54;

// The first 1216 bits of 2/pi after the point.
inline constexpr std::uint32_t kTwoByPiBits[38] = {
    0xA2F9836E, 0x4E441529, 0xFC2757D1, 0xF534DDC0, 0xDB629599, 0x3C439041, 0xFE5163AB, 0xDEBBC561,
    0xB7246E3A, 0x424DD2E0, 0x06492EEA, 0x09D1921C, 0xFE1DEB1C, 0xB129A73E, 0xE88235F5, 0x2EBB4484,
    0xE99C7026, 0xB45F7E41, 0x3991D639, 0x835339F4, 0x9C845F8B, 0xBDF9283B, 0x1FF897FF, 0xDE05980F,
    0xEF2F118B, 0x5A0A6D1F, 0x6D367ECF, 0x27CB09B7, 0x4F463F66, 0x9E5FEA2D, 0x7527BAC7, 0xEBE5F17B,
    0x3D0739F7, 0x8A5292EA, 0x6BFB5FB1, 0x1F8D5D08, 0x56033046, 0xFC7B6BAB,
};

}  // namespace puppetri::elementary
