//! Minimax coefficients in ascending powers, as `data/poly/make.py` prints them. Every entry is an exact `f32`.

/// `2^x on [-0.5, 0.5]`; relative error 3.0e-09 before the rounding of the evaluation.
pub const EXP2: [f64; 6] = [
    0.6931471824645996,
    0.24022647738456726,
    0.05550359934568405,
    0.009618505835533142,
    0.0013390806270763278,
    0.0001532646274426952,
];

/// `e^x on [-0.3469, 0.3469]`; relative error 3.1e-09 before the rounding of the evaluation.
pub const EXP: [f64; 6] =
    [1.0, 0.4999999403953552, 0.1666652113199234, 0.04166827350854874, 0.00836868491023779, 0.001382010756060481];

/// `log2(1 + t) / t on [-0.2929, 0.4142]`; relative error 2.8e-08 before the rounding of the evaluation.
pub const LOG2: [f64; 9] = [
    1.4426950216293335,
    -0.7213473916053772,
    0.48090896010398865,
    -0.3607005774974823,
    0.2879534959793091,
    -0.23901484906673431,
    0.2154807597398758,
    -0.20678746700286865,
    0.12584342062473297,
];

/// `sin(sqrt z) / sqrt z on [0.0, 2.472]`; relative error 6.3e-09 before the rounding of the evaluation.
pub const SIN: [f64; 4] = [-0.16666659712791443, 0.008333069272339344, -0.00019809768127743155, 2.6060538402816746e-06];

/// `acos(x) / sqrt(1 - x) on [0.0, 1.0]`; relative error 2.8e-08 before the rounding of the evaluation.
pub const ACOS: [f64; 9] = [
    1.5707963705062866,
    -0.21460704505443573,
    0.08915019780397415,
    -0.05153333395719528,
    0.036200154572725296,
    -0.028362322598695755,
    0.019947517663240433,
    -0.009410063736140728,
    0.00203212583437562,
];

/// `atan(sqrt z) / sqrt z on [0.0, 1.0]`; relative error 2.6e-09 before the rounding of the evaluation.
pub const ATAN: [f64; 10] = [
    1.0,
    -0.33333298563957214,
    0.1999852955341339,
    -0.14264015853405,
    0.10950880497694016,
    -0.08399306237697601,
    0.05788138881325722,
    -0.031096987426280975,
    0.01086869090795517,
    -0.0017828245181590319,
];

/// `numerator of erf(sqrt z) / sqrt z on [0.0, 15.37]`; relative error 5.6e-08 before the rounding of the evaluation.
pub const ERF_P: [f64; 6] = [
    1.1283791065216064,
    0.19040751457214355,
    0.05274857580661774,
    0.0037657173816114664,
    0.0002848771691787988,
    2.0502993720583618e-06,
];

/// `denominator of erf(sqrt z) / sqrt z on [0.0, 15.37]`; relative error 5.6e-08 before the rounding of the evaluation.
pub const ERF_Q: [f64; 6] =
    [1.0, 0.5020767450332642, 0.11410942673683167, 0.01496928371489048, 0.001162544242106378, 3.8091751775937155e-05];

/// `numerator of erf_inv(x) / x over w = -log2(1 - x^2) on [0.0, 23.1]`; relative error 3.2e-08 before the rounding of the evaluation.
pub const ERF_INV_P: [f64; 6] = [
    0.8862269520759583,
    0.21249136328697205,
    0.028632232919335365,
    0.002586335176602006,
    0.00014864339027553797,
    3.888471383106662e-06,
];

/// `denominator of erf_inv(x) / x over w = -log2(1 - x^2) on [0.0, 23.1]`; relative error 3.2e-08 before the rounding of the evaluation.
pub const ERF_INV_Q: [f64; 6] = [
    1.0,
    0.05830570310354233,
    0.01546538807451725,
    0.0006252677994780242,
    4.143372643738985e-05,
    2.0641917330976867e-07,
];
