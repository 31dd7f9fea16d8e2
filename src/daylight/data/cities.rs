//! Cities of the world: position to a hundredth of a degree (about a kilometre), ISO 3166 code of the country, IANA time zone.

use crate::daylight::cities::City;

const fn city(
    name: &'static str,
    other_name: &'static str,
    country: &'static str,
    latitude: f64,
    longitude: f64,
    zone: chrono_tz::Tz,
) -> City {
    City {
        name,
        other_name,
        country,
        latitude,
        longitude,
        zone,
    }
}

/// Writes a row as a call.
macro_rules! cities {
    ($($name:literal $other:literal $country:literal $latitude:literal $longitude:literal $area:ident / $zone:ident $(/ $part:ident)?;)*) => {
        &[$(city($name, $other, $country, $latitude, $longitude, chrono_tz::$area::$zone$(::$part)?)),*]
    };
}

/// Name, another name, country, latitude, longitude, time zone.
pub const CITIES: &[City] = cities! {
    // Northern Europe
    "Copenhagen" "København" "DK" 55.68 12.57 Europe/Copenhagen;
    "Kongens Lyngby" "DTU" "DK" 55.79 12.52 Europe/Copenhagen;
    "Aarhus" "Århus" "DK" 56.16 10.21 Europe/Copenhagen;
    "Tórshavn" "" "FO" 62.01 -6.77 Atlantic/Faroe;
    "Reykjavík" "" "IS" 64.15 -21.94 Atlantic/Reykjavik;
    "Oslo" "" "NO" 59.91 10.75 Europe/Oslo;
    "Bergen" "" "NO" 60.39 5.32 Europe/Oslo;
    "Trondheim" "" "NO" 63.43 10.40 Europe/Oslo;
    "Tromsø" "" "NO" 69.65 18.96 Europe/Oslo;
    "Longyearbyen" "Svalbard" "SJ" 78.22 15.65 Arctic/Longyearbyen;
    "Stockholm" "" "SE" 59.33 18.07 Europe/Stockholm;
    "Gothenburg" "Göteborg" "SE" 57.71 11.97 Europe/Stockholm;
    "Malmö" "" "SE" 55.61 13.00 Europe/Stockholm;
    "Kiruna" "" "SE" 67.86 20.23 Europe/Stockholm;
    "Helsinki" "" "FI" 60.17 24.94 Europe/Helsinki;
    "Rovaniemi" "" "FI" 66.50 25.73 Europe/Helsinki;
    "Tallinn" "" "EE" 59.44 24.75 Europe/Tallinn;
    "Riga" "" "LV" 56.95 24.11 Europe/Riga;
    "Vilnius" "" "LT" 54.69 25.28 Europe/Vilnius;
    "London" "" "GB" 51.51 -0.13 Europe/London;
    "Manchester" "" "GB" 53.48 -2.24 Europe/London;
    "Edinburgh" "" "GB" 55.95 -3.19 Europe/London;
    "Dublin" "Baile Átha Cliath" "IE" 53.35 -6.26 Europe/Dublin;
    // Western and central Europe
    "Amsterdam" "" "NL" 52.37 4.90 Europe/Amsterdam;
    "Rotterdam" "" "NL" 51.92 4.48 Europe/Amsterdam;
    "Brussels" "Bruxelles" "BE" 50.85 4.35 Europe/Brussels;
    "Luxembourg" "" "LU" 49.61 6.13 Europe/Luxembourg;
    "Paris" "" "FR" 48.86 2.35 Europe/Paris;
    "Lyon" "" "FR" 45.76 4.84 Europe/Paris;
    "Marseille" "" "FR" 43.30 5.37 Europe/Paris;
    "Berlin" "" "DE" 52.52 13.40 Europe/Berlin;
    "Hamburg" "" "DE" 53.55 9.99 Europe/Berlin;
    "Cologne" "Köln" "DE" 50.94 6.96 Europe/Berlin;
    "Frankfurt" "" "DE" 50.11 8.68 Europe/Berlin;
    "Munich" "München" "DE" 48.14 11.58 Europe/Berlin;
    "Stuttgart" "" "DE" 48.78 9.18 Europe/Berlin;
    "Vienna" "Wien" "AT" 48.21 16.37 Europe/Vienna;
    "Innsbruck" "" "AT" 47.27 11.39 Europe/Vienna;
    "Zürich" "" "CH" 47.37 8.54 Europe/Zurich;
    "Geneva" "Genève" "CH" 46.20 6.14 Europe/Zurich;
    "Prague" "Praha" "CZ" 50.08 14.44 Europe/Prague;
    "Bratislava" "" "SK" 48.15 17.11 Europe/Bratislava;
    "Budapest" "" "HU" 47.50 19.04 Europe/Budapest;
    "Warsaw" "Warszawa" "PL" 52.23 21.01 Europe/Warsaw;
    "Kraków" "Cracow" "PL" 50.06 19.94 Europe/Warsaw;
    "Gdańsk" "" "PL" 54.35 18.65 Europe/Warsaw;
    // Southern and eastern Europe
    "Lisbon" "Lisboa" "PT" 38.72 -9.14 Europe/Lisbon;
    "Porto" "" "PT" 41.15 -8.61 Europe/Lisbon;
    "Ponta Delgada" "Azores" "PT" 37.74 -25.67 Atlantic/Azores;
    "Madrid" "" "ES" 40.42 -3.70 Europe/Madrid;
    "Barcelona" "" "ES" 41.39 2.17 Europe/Madrid;
    "Seville" "Sevilla" "ES" 37.39 -5.98 Europe/Madrid;
    "Las Palmas" "Gran Canaria" "ES" 28.12 -15.43 Atlantic/Canary;
    "Rome" "Roma" "IT" 41.90 12.50 Europe/Rome;
    "Milan" "Milano" "IT" 45.46 9.19 Europe/Rome;
    "Venice" "Venezia" "IT" 45.44 12.33 Europe/Rome;
    "Naples" "Napoli" "IT" 40.85 14.27 Europe/Rome;
    "Valletta" "" "MT" 35.90 14.51 Europe/Malta;
    "Ljubljana" "" "SI" 46.06 14.51 Europe/Ljubljana;
    "Zagreb" "" "HR" 45.81 15.98 Europe/Zagreb;
    "Sarajevo" "" "BA" 43.86 18.41 Europe/Sarajevo;
    "Belgrade" "Beograd" "RS" 44.79 20.45 Europe/Belgrade;
    "Skopje" "" "MK" 42.00 21.43 Europe/Skopje;
    "Tirana" "Tiranë" "AL" 41.33 19.82 Europe/Tirane;
    "Athens" "Athína" "GR" 37.98 23.73 Europe/Athens;
    "Thessaloniki" "" "GR" 40.64 22.94 Europe/Athens;
    "Sofia" "" "BG" 42.70 23.32 Europe/Sofia;
    "Bucharest" "București" "RO" 44.43 26.10 Europe/Bucharest;
    "Chișinău" "" "MD" 47.01 28.86 Europe/Chisinau;
    "Kyiv" "Kiev" "UA" 50.45 30.52 Europe/Kyiv;
    "Odesa" "Odessa" "UA" 46.48 30.73 Europe/Kyiv;
    "Minsk" "" "BY" 53.90 27.57 Europe/Minsk;
    "Moscow" "Moskva" "RU" 55.76 37.62 Europe/Moscow;
    "Saint Petersburg" "Leningrad" "RU" 59.94 30.31 Europe/Moscow;
    "Murmansk" "" "RU" 68.97 33.08 Europe/Moscow;
    "Istanbul" "" "TR" 41.01 28.98 Europe/Istanbul;
    "Ankara" "" "TR" 39.93 32.86 Europe/Istanbul;
    "Nicosia" "Lefkosia" "CY" 35.17 33.37 Asia/Nicosia;
    // Northern and central Asia
    "Yekaterinburg" "" "RU" 56.84 60.61 Asia/Yekaterinburg;
    "Novosibirsk" "" "RU" 55.03 82.92 Asia/Novosibirsk;
    "Norilsk" "" "RU" 69.35 88.20 Asia/Krasnoyarsk;
    "Irkutsk" "" "RU" 52.29 104.28 Asia/Irkutsk;
    "Yakutsk" "" "RU" 62.03 129.73 Asia/Yakutsk;
    "Vladivostok" "" "RU" 43.12 131.89 Asia/Vladivostok;
    "Tbilisi" "" "GE" 41.72 44.79 Asia/Tbilisi;
    "Yerevan" "" "AM" 40.18 44.51 Asia/Yerevan;
    "Baku" "" "AZ" 40.41 49.87 Asia/Baku;
    "Almaty" "" "KZ" 43.24 76.89 Asia/Almaty;
    "Tashkent" "Toshkent" "UZ" 41.30 69.24 Asia/Tashkent;
    "Bishkek" "" "KG" 42.87 74.59 Asia/Bishkek;
    "Ulaanbaatar" "Ulan Bator" "MN" 47.92 106.92 Asia/Ulaanbaatar;
    // Western Asia
    "Jerusalem" "" "IL" 31.77 35.21 Asia/Jerusalem;
    "Tel Aviv" "" "IL" 32.08 34.78 Asia/Jerusalem;
    "Amman" "" "JO" 31.95 35.93 Asia/Amman;
    "Beirut" "" "LB" 33.89 35.50 Asia/Beirut;
    "Damascus" "" "SY" 33.51 36.29 Asia/Damascus;
    "Baghdad" "" "IQ" 33.31 44.37 Asia/Baghdad;
    "Tehran" "" "IR" 35.69 51.39 Asia/Tehran;
    "Riyadh" "" "SA" 24.71 46.68 Asia/Riyadh;
    "Mecca" "Makkah" "SA" 21.42 39.83 Asia/Riyadh;
    "Kuwait City" "" "KW" 29.38 47.98 Asia/Kuwait;
    "Doha" "" "QA" 25.29 51.53 Asia/Qatar;
    "Dubai" "" "AE" 25.20 55.27 Asia/Dubai;
    "Abu Dhabi" "" "AE" 24.45 54.38 Asia/Dubai;
    "Muscat" "" "OM" 23.59 58.41 Asia/Muscat;
    "Sanaa" "" "YE" 15.37 44.19 Asia/Aden;
    // Southern Asia
    "Kabul" "" "AF" 34.53 69.17 Asia/Kabul;
    "Karachi" "" "PK" 24.86 67.01 Asia/Karachi;
    "Lahore" "" "PK" 31.55 74.34 Asia/Karachi;
    "Delhi" "New Delhi" "IN" 28.61 77.21 Asia/Kolkata;
    "Mumbai" "Bombay" "IN" 19.08 72.88 Asia/Kolkata;
    "Bengaluru" "Bangalore" "IN" 12.97 77.59 Asia/Kolkata;
    "Kolkata" "Calcutta" "IN" 22.57 88.36 Asia/Kolkata;
    "Chennai" "Madras" "IN" 13.08 80.27 Asia/Kolkata;
    "Ahmedabad" "" "IN" 23.02 72.57 Asia/Kolkata;
    "Chandigarh" "" "IN" 30.73 76.78 Asia/Kolkata;
    "Kathmandu" "" "NP" 27.72 85.32 Asia/Kathmandu;
    "Thimphu" "" "BT" 27.47 89.64 Asia/Thimphu;
    "Dhaka" "" "BD" 23.81 90.41 Asia/Dhaka;
    "Colombo" "" "LK" 6.93 79.86 Asia/Colombo;
    "Malé" "" "MV" 4.18 73.51 Indian/Maldives;
    // Eastern and south-eastern Asia
    "Beijing" "Peking" "CN" 39.90 116.41 Asia/Shanghai;
    "Shanghai" "" "CN" 31.23 121.47 Asia/Shanghai;
    "Guangzhou" "Canton" "CN" 23.13 113.26 Asia/Shanghai;
    "Chengdu" "" "CN" 30.57 104.07 Asia/Shanghai;
    "Harbin" "" "CN" 45.80 126.53 Asia/Shanghai;
    "Ürümqi" "" "CN" 43.83 87.62 Asia/Urumqi;
    "Lhasa" "" "CN" 29.65 91.14 Asia/Shanghai;
    "Hong Kong" "" "HK" 22.32 114.17 Asia/Hong_Kong;
    "Taipei" "" "TW" 25.03 121.57 Asia/Taipei;
    "Seoul" "" "KR" 37.57 126.98 Asia/Seoul;
    "Busan" "Pusan" "KR" 35.18 129.08 Asia/Seoul;
    "Pyongyang" "" "KP" 39.04 125.76 Asia/Pyongyang;
    "Tokyo" "" "JP" 35.68 139.69 Asia/Tokyo;
    "Kyoto" "" "JP" 35.01 135.77 Asia/Tokyo;
    "Osaka" "" "JP" 34.69 135.50 Asia/Tokyo;
    "Sapporo" "" "JP" 43.06 141.35 Asia/Tokyo;
    "Naha" "Okinawa" "JP" 26.21 127.68 Asia/Tokyo;
    "Yangon" "Rangoon" "MM" 16.84 96.17 Asia/Yangon;
    "Bangkok" "" "TH" 13.76 100.50 Asia/Bangkok;
    "Vientiane" "" "LA" 17.98 102.63 Asia/Vientiane;
    "Phnom Penh" "" "KH" 11.56 104.92 Asia/Phnom_Penh;
    "Hanoi" "Hà Nội" "VN" 21.03 105.85 Asia/Bangkok;
    "Ho Chi Minh City" "Saigon" "VN" 10.82 106.63 Asia/Ho_Chi_Minh;
    "Kuala Lumpur" "" "MY" 3.139 101.69 Asia/Kuala_Lumpur;
    "Singapore" "" "SG" 1.35 103.82 Asia/Singapore;
    "Jakarta" "" "ID" -6.21 106.85 Asia/Jakarta;
    "Denpasar" "Bali" "ID" -8.65 115.22 Asia/Makassar;
    "Manila" "" "PH" 14.60 120.98 Asia/Manila;
    // Africa
    "Cairo" "" "EG" 30.04 31.24 Africa/Cairo;
    "Alexandria" "" "EG" 31.20 29.92 Africa/Cairo;
    "Luxor" "" "EG" 25.69 32.64 Africa/Cairo;
    "Tripoli" "" "LY" 32.89 13.19 Africa/Tripoli;
    "Tunis" "" "TN" 36.81 10.18 Africa/Tunis;
    "Algiers" "Alger" "DZ" 36.75 3.06 Africa/Algiers;
    "Casablanca" "" "MA" 33.57 -7.59 Africa/Casablanca;
    "Marrakesh" "Marrakech" "MA" 31.63 -7.98 Africa/Casablanca;
    "Khartoum" "" "SD" 15.50 32.56 Africa/Khartoum;
    "Timbuktu" "Tombouctou" "ML" 16.77 -3.01 Africa/Bamako;
    "Dakar" "" "SN" 14.72 -17.47 Africa/Dakar;
    "Praia" "" "CV" 14.93 -23.51 Atlantic/Cape_Verde;
    "Abidjan" "" "CI" 5.36 -4.01 Africa/Abidjan;
    "Accra" "" "GH" 5.60 -0.19 Africa/Accra;
    "Lagos" "" "NG" 6.52 3.38 Africa/Lagos;
    "Abuja" "" "NG" 9.08 7.40 Africa/Lagos;
    "Kinshasa" "" "CD" -4.44 15.27 Africa/Kinshasa;
    "Addis Ababa" "" "ET" 9.03 38.74 Africa/Addis_Ababa;
    "Mogadishu" "Muqdisho" "SO" 2.05 45.32 Africa/Mogadishu;
    "Nairobi" "" "KE" -1.29 36.82 Africa/Nairobi;
    "Kampala" "" "UG" 0.35 32.58 Africa/Kampala;
    "Kigali" "" "RW" -1.94 30.06 Africa/Kigali;
    "Dar es Salaam" "" "TZ" -6.79 39.21 Africa/Dar_es_Salaam;
    "Luanda" "" "AO" -8.84 13.29 Africa/Luanda;
    "Lusaka" "" "ZM" -15.39 28.32 Africa/Lusaka;
    "Harare" "" "ZW" -17.83 31.05 Africa/Harare;
    "Windhoek" "" "NA" -22.56 17.07 Africa/Windhoek;
    "Gaborone" "" "BW" -24.65 25.91 Africa/Gaborone;
    "Maputo" "" "MZ" -25.97 32.57 Africa/Maputo;
    "Johannesburg" "" "ZA" -26.20 28.05 Africa/Johannesburg;
    "Cape Town" "Kaapstad" "ZA" -33.92 18.42 Africa/Johannesburg;
    "Antananarivo" "" "MG" -18.88 47.51 Indian/Antananarivo;
    "Port Louis" "Mauritius" "MU" -20.16 57.50 Indian/Mauritius;
    // North America
    "Nuuk" "Godthåb" "GL" 64.18 -51.72 America/Nuuk;
    "Qaanaaq" "Thule" "GL" 77.47 -69.23 America/Thule;
    "Iqaluit" "" "CA" 63.75 -68.52 America/Iqaluit;
    "St. John's" "" "CA" 47.56 -52.71 America/St_Johns;
    "Halifax" "" "CA" 44.65 -63.58 America/Halifax;
    "Québec" "" "CA" 46.81 -71.21 America/Toronto;
    "Montréal" "" "CA" 45.50 -73.57 America/Toronto;
    "Ottawa" "" "CA" 45.42 -75.70 America/Toronto;
    "Toronto" "" "CA" 43.65 -79.38 America/Toronto;
    "Winnipeg" "" "CA" 49.90 -97.14 America/Winnipeg;
    "Calgary" "" "CA" 51.05 -114.07 America/Edmonton;
    "Vancouver" "" "CA" 49.28 -123.12 America/Vancouver;
    "Whitehorse" "" "CA" 60.72 -135.06 America/Whitehorse;
    "New York" "" "US" 40.71 -74.01 America/New_York;
    "Boston" "" "US" 42.36 -71.06 America/New_York;
    "Washington" "" "US" 38.91 -77.04 America/New_York;
    "Philadelphia" "" "US" 39.95 -75.17 America/New_York;
    "Ithaca" "" "US" 42.44 -76.50 America/New_York;
    "Atlanta" "" "US" 33.75 -84.39 America/New_York;
    "Miami" "" "US" 25.76 -80.19 America/New_York;
    "Detroit" "" "US" 42.33 -83.05 America/Detroit;
    "Chicago" "" "US" 41.88 -87.63 America/Chicago;
    "Minneapolis" "" "US" 44.98 -93.27 America/Chicago;
    "New Orleans" "" "US" 29.95 -90.07 America/Chicago;
    "Houston" "" "US" 29.76 -95.37 America/Chicago;
    "Dallas" "" "US" 32.78 -96.80 America/Chicago;
    "Denver" "" "US" 39.74 -104.99 America/Denver;
    "Salt Lake City" "" "US" 40.76 -111.89 America/Denver;
    "Phoenix" "" "US" 33.45 -112.07 America/Phoenix;
    "Las Vegas" "" "US" 36.17 -115.14 America/Los_Angeles;
    "Los Angeles" "" "US" 34.05 -118.24 America/Los_Angeles;
    "San Francisco" "" "US" 37.77 -122.42 America/Los_Angeles;
    "Portland" "" "US" 45.52 -122.68 America/Los_Angeles;
    "Seattle" "" "US" 47.61 -122.33 America/Los_Angeles;
    "Anchorage" "" "US" 61.22 -149.90 America/Anchorage;
    "Fairbanks" "" "US" 64.84 -147.72 America/Anchorage;
    "Utqiaġvik" "Barrow" "US" 71.29 -156.79 America/Anchorage;
    "Honolulu" "Hawaii" "US" 21.31 -157.86 Pacific/Honolulu;
    // Central America and the Caribbean
    "Mexico City" "Ciudad de México" "MX" 19.43 -99.13 America/Mexico_City;
    "Guadalajara" "" "MX" 20.67 -103.35 America/Mexico_City;
    "Tijuana" "" "MX" 32.51 -117.04 America/Tijuana;
    "Cancún" "" "MX" 21.16 -86.85 America/Cancun;
    "Guatemala City" "" "GT" 14.63 -90.51 America/Guatemala;
    "San José" "" "CR" 9.93 -84.08 America/Costa_Rica;
    "Panama City" "Panamá" "PA" 8.98 -79.52 America/Panama;
    "Havana" "La Habana" "CU" 23.11 -82.37 America/Havana;
    "Kingston" "" "JM" 17.97 -76.79 America/Jamaica;
    "Santo Domingo" "" "DO" 18.49 -69.93 America/Santo_Domingo;
    "San Juan" "" "PR" 18.47 -66.11 America/Puerto_Rico;
    // South America
    "Caracas" "" "VE" 10.48 -66.90 America/Caracas;
    "Bogotá" "" "CO" 4.71 -74.07 America/Bogota;
    "Medellín" "" "CO" 6.24 -75.58 America/Bogota;
    "Quito" "" "EC" -0.18 -78.47 America/Guayaquil;
    "Puerto Ayora" "Galápagos" "EC" -0.74 -90.31 Pacific/Galapagos;
    "Lima" "" "PE" -12.05 -77.04 America/Lima;
    "Cusco" "Cuzco" "PE" -13.53 -71.97 America/Lima;
    "La Paz" "" "BO" -16.50 -68.15 America/La_Paz;
    "Manaus" "" "BR" -3.12 -60.02 America/Manaus;
    "Fortaleza" "" "BR" -3.73 -38.53 America/Fortaleza;
    "Recife" "" "BR" -8.05 -34.88 America/Recife;
    "Salvador" "" "BR" -12.97 -38.50 America/Bahia;
    "Brasília" "" "BR" -15.79 -47.88 America/Sao_Paulo;
    "Rio de Janeiro" "" "BR" -22.91 -43.17 America/Sao_Paulo;
    "São Paulo" "" "BR" -23.55 -46.63 America/Sao_Paulo;
    "Porto Alegre" "" "BR" -30.03 -51.23 America/Sao_Paulo;
    "Asunción" "" "PY" -25.26 -57.58 America/Asuncion;
    "Montevideo" "" "UY" -34.90 -56.16 America/Montevideo;
    "Buenos Aires" "" "AR" -34.60 -58.38 America/Argentina/Buenos_Aires;
    "Ushuaia" "" "AR" -54.80 -68.30 America/Argentina/Ushuaia;
    "Santiago" "" "CL" -33.45 -70.67 America/Santiago;
    "Punta Arenas" "" "CL" -53.16 -70.91 America/Punta_Arenas;
    "Hanga Roa" "Easter Island" "CL" -27.15 -109.43 Pacific/Easter;
    "Stanley" "Falkland Islands" "FK" -51.70 -57.85 Atlantic/Stanley;
    // Oceania
    "Perth" "" "AU" -31.95 115.86 Australia/Perth;
    "Darwin" "" "AU" -12.46 130.84 Australia/Darwin;
    "Alice Springs" "" "AU" -23.70 133.88 Australia/Darwin;
    "Adelaide" "" "AU" -34.93 138.60 Australia/Adelaide;
    "Brisbane" "" "AU" -27.47 153.03 Australia/Brisbane;
    "Canberra" "" "AU" -35.28 149.13 Australia/Sydney;
    "Sydney" "" "AU" -33.87 151.21 Australia/Sydney;
    "Melbourne" "" "AU" -37.81 144.96 Australia/Melbourne;
    "Hobart" "" "AU" -42.88 147.33 Australia/Hobart;
    "Auckland" "" "NZ" -36.85 174.76 Pacific/Auckland;
    "Wellington" "" "NZ" -41.29 174.78 Pacific/Auckland;
    "Christchurch" "" "NZ" -43.53 172.64 Pacific/Auckland;
    "Port Moresby" "" "PG" -9.44 147.18 Pacific/Port_Moresby;
    "Nouméa" "" "NC" -22.27 166.46 Pacific/Noumea;
    "Suva" "Fiji" "FJ" -18.14 178.44 Pacific/Fiji;
    "Apia" "Samoa" "WS" -13.83 -171.77 Pacific/Apia;
    "Papeete" "Tahiti" "PF" -17.54 -149.57 Pacific/Tahiti;
    "Hagåtña" "Guam" "GU" 13.47 144.75 Pacific/Guam;
    // Antarctica
    "McMurdo Station" "" "AQ" -77.85 166.67 Antarctica/McMurdo;
    "South Pole" "Amundsen-Scott" "AQ" -90.0 0.0 Antarctica/McMurdo;
};
